"""Values: what an ecology, a task and a configuration are, with no RDF, network, clock or file in them."""

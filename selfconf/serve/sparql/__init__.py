"""The SPARQL endpoint: requests by the SPARQL 1.1 protocol, and the description of the service."""

"""A living ecology of many components at many sites: discovery, `run`, failover, memory, and what it costs idle."""

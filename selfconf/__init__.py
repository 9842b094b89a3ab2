"""selfconf: components of a robot ecology that wire themselves."""

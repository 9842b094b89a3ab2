"""What travels between sites, components and configurators, with no network in it.

`keys` are the keys of an ecology, `endpoints` are what programs connect to, `messages` are values, `codec` is their
encoding as JSON, and `activation` is the table by which a component obeys.
"""

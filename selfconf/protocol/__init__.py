"""What travels between sites, components and configurators, with no network in it.

`keys` are the keys of an ecology, `endpoints` are what programs connect to, `messages` are values, `codec` is their
encoding as JSON, and `activation` is the table by which a component obeys.
"""

from importlib import import_module

# orjson, which `codec` takes, imports these while it is initialised, and crashes where one of them raises, as by the
# KeyboardInterrupt of a signal. For what is imported already no code of Python runs, which a signal could interrupt.
for _taken_by_orjson in ("dataclasses", "datetime", "enum", "json", "uuid"):
    import_module(_taken_by_orjson)

"""A configuration as a JSON object and back, for the record of a task that lives in the ecology."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from selfconf.errors import PeerError
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.protocol.json_values import decode_term, encode_term, read_iri, read_iris, read_name, read_values


def configuration_record(configuration: Configuration) -> dict[str, Any]:
    """A configuration as a JSON object."""
    return {
        "template": configuration.template,
        "roles": [[one.role, list(one.components)] for one in configuration.assignments],
        "connections": [[one.source, one.output, one.sink, one.input] for one in configuration.connections],
        "parameters": [[one.component, one.name, encode_term(one.value)] for one in configuration.settings],
        "bindings": {name: encode_term(value) for name, value in configuration.bindings.items()},
        **({"recruits": list(configuration.recruits)} if configuration.recruits else {}),
    }


def recorded_configuration(record: Mapping[str, Any]) -> Configuration:
    """The configuration that a record speaks of. Raises PeerError for what is none."""
    try:
        return Configuration(
            read_iri(record["template"]),
            tuple(Assignment(read_iri(role), read_iris(components)) for role, components in record["roles"]),
            tuple(
                Connection(read_iri(source), read_name(output), read_iri(sink), read_name(port))
                for source, output, sink, port in record["connections"]
            ),
            tuple(
                ParameterSetting(read_iri(component), read_name(name), decode_term(value))
                for component, name, value in record["parameters"]
            ),
            read_values(record["bindings"]),
            read_iris(record.get("recruits", [])),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise PeerError(f"not the record of a configuration: {error!r}") from None

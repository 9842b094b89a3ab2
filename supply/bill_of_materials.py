"""The bill of materials in the wheel (PEP 770): what selfconf needs, in the versions that it is tested with.

It is CycloneDX 1.6 as JSON, `sboms/selfconf.cdx.json` in the folder `.dist-info`, made by `hatchling` as it builds a
wheel from `pyproject.toml` and `requirements.txt`. The wheel itself holds no code of others: the core's distributions
are `required`, those of extras `optional`, and those for building, tests and benchmarks are left out. A version that is
taken on some platforms only says on which (`selfconf:marker`). The same files make the same bytes: there is no time in
it, and its serial number is the hash of the rest.
"""

from __future__ import annotations

import json
import runpy
import tempfile
import uuid
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cyclonedx.model import Property
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentScope, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from packageurl import PackageURL

NAME = "selfconf.cdx.json"
INSIDE = frozenset({"-", "build", "dev", "bench"})
"""Who needs what no user installs by an extra; `-` is the core."""


def bill_of_materials(name: str, version: str, pinned: Iterable[tuple[frozenset[str], str]]) -> str:
    """The document for a version, by the requirements of the file and who needs each."""
    bom = Bom()
    whole = Component(
        type=ComponentType.LIBRARY,
        name=name,
        version=version,
        bom_ref=f"pkg:pypi/{name}@{version}",
        purl=PackageURL("pypi", name=name, version=version),
        licenses=[LicenseExpression("Apache-2.0")],
    )
    bom.metadata.component = whole
    parts = [part for part in (_part(who, requirement) for who, requirement in pinned) if part is not None]
    bom.components.update(parts)
    bom.register_dependency(whole, [part for part in parts if part.scope is ComponentScope.REQUIRED])
    document: dict[str, Any] = json.loads(JsonV1Dot6(bom).output_as_string())
    document["metadata"].pop("timestamp")
    document.pop("serialNumber")
    serial = uuid.uuid5(uuid.NAMESPACE_URL, _written(document))
    return _written({**document, "serialNumber": f"urn:uuid:{serial}"})


def _part(who: frozenset[str], requirement: str) -> Component | None:
    """A distribution that users install; None for one that they do not."""
    if "-" not in who and who <= INSIDE:
        return None
    pin, _, marker = requirement.splitlines()[0].removesuffix("\\").partition(";")
    name, _, version = pin.strip().partition("==")
    extras = sorted(who - INSIDE)
    said = {"selfconf:marker": marker.strip(), "selfconf:extras": "" if "-" in who else " ".join(extras)}
    return Component(
        type=ComponentType.LIBRARY,
        name=name,
        version=version,
        bom_ref=f"pkg:pypi/{name}@{version}",
        purl=PackageURL("pypi", name=name, version=version),
        scope=ComponentScope.REQUIRED if "-" in who else ComponentScope.OPTIONAL,
        properties=[Property(name=key, value=value) for key, value in said.items() if value],
    )


def _written(document: dict[str, Any]) -> str:
    return json.dumps(document, indent=1, sort_keys=True) + "\n"


class BillOfMaterials(BuildHookInterface[Any]):
    """Has hatchling put the document into the wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the document for the wheel that is being built; an editable one needs none."""
        if version == "editable":
            return
        root = Path(self.root)
        pins = runpy.run_path(str(root / "supply" / "pins.py"))  # the folder is no installed package
        pinned = pins["requirements"]((root / "requirements.txt").read_text("utf-8"))
        metadata = self.metadata.core
        self._folder = tempfile.TemporaryDirectory()
        document = Path(self._folder.name) / NAME
        document.write_text(bill_of_materials(metadata.name, self.metadata.version, pinned), "utf-8")
        build_data["sbom_files"].append(str(document))

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove the file that has been put into the wheel."""
        if version != "editable":
            self._folder.cleanup()

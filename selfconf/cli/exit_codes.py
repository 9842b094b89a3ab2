"""What commands return where that depends on whether all of an ecology has answered."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from selfconf.api.living import LivingEcology


def code_of_tasks(ecology: LivingEcology) -> int:
    """0 once every configurator of an ecology that was asked for its tasks has answered, also if there is no task.

    2 if one lives or holds components and does not answer, or if a run of this machine is suspended.
    """
    return 2 if ecology.silent or ecology.suspended else 0

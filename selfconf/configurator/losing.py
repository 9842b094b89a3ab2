"""A component is lost: it has failed, its life has ended, or it cannot be had; the rest is kept, or comes to rest.

`REPAIR` keeps what runs and changes what must change; `DISMANTLE` first takes everything down, as the paper does
(section 4.2). Either way the lost component is turned off and its profile dropped, and the search runs again.
"""

from __future__ import annotations

from selfconf.configurator import deploying, phases
from selfconf.configurator.deploying import DEPLOYING, Reaction, then
from selfconf.configurator.effects import ReleaseFrom, WakeUp
from selfconf.configurator.events import Call, Failed
from selfconf.configurator.state import Held, Loss, Phase, Policy, Revival, State
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause

PROCESS_ENDS = (Cause.CRASH, Cause.HUNG)
"""The causes for which a component is started again: a site ends a process that hangs."""
GOES_ON = (Cause.YIELD, Cause.LET_GO)
"""The causes for which a component has not failed: another task asks for it, or it has let go of this one."""


def heed_failure(state: State, event: Failed) -> Reaction:
    """A component has failed, has ended, has let go of the task, or is asked to; others do not matter to it."""
    held = state.held.get(event.component)
    if held is None:
        return _ended_since(state, event), ()
    if state.phase is Phase.DISMANTLING:
        return state, ()
    known = None if held.life else _loss_in(state, event)
    # A life that hangs does not answer that it is reserved.
    if known is not None and (event.component, Call.RESERVE) not in state.pending:
        return _lost_already(state, event.component)
    if _passes_over(held, event):
        return state, ()
    startable = event.startable and event.cause in PROCESS_ENDS
    if startable:  # the next life has not made the deployment begin anew
        state = replace(state, repeats={c: times for c, times in state.repeats.items() if c != event.component})
    if known is not None and startable:
        loss = replace(known, revival=Revival.where(startable), again=True)
    else:
        life, busy = event.life or held.life, event.cause is Cause.YIELD
        loss = Loss(event.cause, event.detail, life, busy=busy, revival=Revival.where(startable))
    if event.cause not in GOES_ON:
        return lose(state, event.component, loss)
    return _let_go(state, event.component, loss)


def _loss_in(state: State, event: Failed) -> Loss | None:
    """The last loss of a component, if that was the end, or the hanging, of the very life of an event."""
    known = state.ended_lives.get(event.component)
    return known if known is not None and known.life == event.life else None


def _ended_since(state: State, event: Failed) -> State:
    """Note that the life has ended in which a component was lost, at that moment or since.

    Its site can start it again. Where no site is seen that can, what was silent may only have been cut off.
    """
    loss = state.lost.get(event.component)
    if loss is None or event.cause is not Cause.CRASH:
        return state
    in_that_life = loss.lasts and loss.life == event.life
    if event.startable and (loss.cause is Cause.CRASH or in_that_life):
        known = replace(loss, revival=max(loss.revival, Revival.POSSIBLE))
    elif in_that_life and loss.cause is Cause.SILENCE:
        known = replace(loss, cause=Cause.CRASH, detail=event.detail)
    else:
        return state
    return replace(state, lost={**state.lost, event.component: known})


def _passes_over(held: Held, event: Failed) -> bool:
    """Whether it is another life than the one that is held which has failed, or one silent that may not have begun.

    A process that has ended without a life is another one as well: it may have found that the component lives already.
    Or it is another task that is asked to let go of it, perhaps for this one, which has neither reserved it nor applied
    to it: an apply that has not been answered yet may be its reservation.
    """
    another = held.life not in ("", event.life) and (event.life != "" or event.cause in PROCESS_ENDS)
    others = event.cause in GOES_ON and not (held.reserved or held.active)
    return another or others or (event.cause is Cause.SILENCE and not held.confirmed)


def _lost_already(state: State, component: IRI) -> Reaction:
    """A component is held anew whose last life was lost: have it woken again, as its site may have thought it alive."""
    return state, (WakeUp(component, state.epoch),) if (component, Call.WAKE) in state.pending else ()


def _let_go(state: State, component: IRI, loss: Loss) -> Reaction:
    """Let go of a component that another task asks for, or that has let go of this one and so can be had again."""
    lost = {**state.lost, component: loss} if loss.busy else state.lost
    if not is_needed(state, component):
        known, effects = lose(state, component, loss)
        return replace(known, lost=lost), effects
    # Nothing may act on a part: all come to rest, the component in its turn.
    return phases.dismantle(replace(state, lost=lost, news=True, has_yielded=loss.busy), Phase.COMPOSING)


def lose(state: State, component: IRI, loss: Loss) -> Reaction:
    """Turn the lost one off, drop its profile, and search again, with the rest kept or dismantled first."""
    epoch = state.epoch + 1
    if loss.startable and component in state.held and not state.held[component].acts:
        loss = replace(loss, revival=Revival.BROKE_EARLY)
    without = replace(
        state,
        epoch=epoch,
        held={kept: held for kept, held in state.held.items() if kept != component},
        owed={**state.owed, component: epoch},
        lost={**state.lost, component: loss},
        queued=state.queued - {component},
        offered=frozenset(),
        return_awaited_since=0,
    )
    if loss.cause in PROCESS_ENDS and loss.life:
        without = replace(without, ended_lives={**state.ended_lives, component: loss})
    effects = (ReleaseFrom(component, epoch),)  # also what seems to be dead: it may hear, and not be heard
    if not is_needed(state, component):
        return then(effects, deploying.deploy(without.unchanged))
    if state.policy is Policy.DISMANTLE:
        return phases.dismantle(without, Phase.COMPOSING)
    if state.phase is Phase.DISCOVERING:
        return without, effects
    return then(effects, phases.compose(without.unchanged))


def is_needed(state: State, component: IRI) -> bool:
    """Whether a component may be part of what is to run: not if that is being deployed, or ran before, without it."""
    wanted = state.wanted
    return state.phase not in DEPLOYING or wanted is None or component in wanted.components

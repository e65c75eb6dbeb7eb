"""The events there are. A new one is a file beside this one, and its class in this list."""

from dilatedem.events.event import Event
from dilatedem.events.inflow import Inflow
from dilatedem.events.outflow import Outflow
from dilatedem.events.relaxation import Relaxation

EVENTS: tuple[type[Event], ...] = (Outflow, Inflow, Relaxation)


def events_of(simulation) -> list[Event]:
    """The events that can happen in a simulation."""
    return [event(simulation) for event in EVENTS if event.interval(simulation.case) > 0.0]

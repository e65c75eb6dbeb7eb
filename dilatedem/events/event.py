"""What an event answers."""

from abc import ABC, abstractmethod

from dilatedem.output.schedule import Schedule


class Event(ABC):
    """Something that changes which bodies there are, or stops them, at times that it owns; one that can happen is made for each
    simulation.
    """

    @classmethod
    @abstractmethod
    def interval(cls, case) -> float:
        """Simulated time between two looks [s], 0 = it cannot happen in this case."""

    def __init__(self, simulation):
        self.schedule = Schedule(self.interval(simulation.case), simulation.dt, simulation.span)

    @abstractmethod
    def happen(self, simulation) -> bool:
        """At a step that is due; returns whether bodies have come or gone."""

    def summary(self, simulation) -> dict:
        """What it has to say in summary.json at this moment."""
        return {}

    def remark(self, simulation) -> str:
        """What the user is to be told of it where a run ends, in a sentence; empty: nothing."""
        return ""

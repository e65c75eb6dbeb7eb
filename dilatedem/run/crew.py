"""How many threads of a run work at a time: all of them, or one while more of them do not pay.

Where the processor's cores have other work, threads that share a step wait for each other, and take many times as long as one; a
few drifting floes are less work than sharing it. What pays is tried, for no number depends on it: from one call of the kernels to
the next, as sums are closed at the end of each.
"""

#: time [s] by which both ways are compared
SAMPLE_S = 0.1
#: a way must take less than this share of the other's time to be changed to
QUICKER = 0.9
#: time [s] until the other way is tried: at first and after a change, and at most, when it has failed again and again
SOON_S, LATE_S = 1.0, 30.0
#: and not before so many times the time that a comparison takes, where it is a long one
SELDOM = 20.0
#: a step that takes so many times as long as at the last trial, or so much less: the other way is tried soon
CHANGED = 1.5
#: shorter runs are over before anything need be said [s]
WORTH_A_WORD_S = 5.0


class Crew:
    """The threads of a run.

    most: how many there are; now: how many work, `most` or 1; all_s, alone_s: wall time of all steps, and of those that one of
    several threads took alone [s].
    """

    def __init__(self, most: int):
        self.most = self.now = most
        self.alone_s = self.all_s = 0.0
        self._patience = SOON_S
        self._since = 0.0  # s, since the last trial
        self._before = 0.0  # s a step, when it ended
        self._trying = False
        self._usual = (0, 0.0)  # steps and s of the last sample of the way that was chosen
        self._sample = (0, 0.0)  # the same of the sample that is being taken

    def took(self, steps: int, seconds: float) -> None:
        """So many steps took the present threads so long [s]."""
        self.all_s += seconds
        if self.most == 1:
            return
        if self.now == 1:
            self.alone_s += seconds
        self._since += seconds
        self._sample = self._sample[0] + steps, self._sample[1] + seconds
        if self._sample[1] >= SAMPLE_S:
            self._judge()

    @property
    def mean(self) -> float:
        """How many threads have worked, on average over wall time."""
        return self.most - (self.most - 1) * (self.alone_s / self.all_s if self.all_s > 0.0 else 0.0)

    def remark(self) -> str:
        """What the user should know of it, in a sentence."""
        if self.all_s < WORTH_A_WORD_S or self.alone_s < self.all_s / 2:
            return ""
        share = f"{100.0 * self.alone_s / self.all_s:.0f} % of the time"
        return f"one of {self.most} threads worked alone in {share}: more were no quicker (a busy processor, or little ice)"

    def _judge(self) -> None:
        """A sample is complete."""
        if self._trying:
            self._trying, self._since, self._before = False, 0.0, _cost(self._usual)
            if _cost(self._sample) < QUICKER * _cost(self._usual):
                self._patience = SOON_S
                self._usual, self._before = self._sample, _cost(self._sample)
            else:
                self._change()
                self._patience = min(2.0 * self._patience, LATE_S)
        else:
            self._usual = self._sample
            if not self._before / CHANGED < _cost(self._usual) < self._before * CHANGED:
                self._patience = SOON_S
            if self._since >= max(self._patience, SELDOM * self._usual[1]):
                self._trying = True
                self._change()
        self._sample = (0, 0.0)

    def _change(self) -> None:
        self.now = self.most if self.now == 1 else 1


def _cost(sample: tuple[int, float]) -> float:
    """s a step."""
    return sample[1] / sample[0]

"""Four challenges, judged by what the running chain shows.

Their texts and chains, and the first sentence, are those of the page without installation,
``docs/chain.md``. A test compares the two.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from crazybilliards.apps.explore.ratio import EnergyRatio
from crazybilliards.apps.explore.session import Session
from crazybilliards.kinetic.kinetic_equation.weak_damping import weak_damping_critical_size
from crazybilliards.model import Chain

SENTENCE = (
    "Hard rods on springs are kicked by noise and collide. At restitution e = 1 collisions keep "
    "the energy, below 1 they take some and above 1 they add some, which decides whether a push "
    "travels, the middle cools or the chain runs away."
)
KICK = 8.0  # free velocity widths that a push adds
ARRIVED = 4.0  # free velocity widths that noise alone hardly ever gives to a rod
_SURE = 3  # standard errors
_FEW = 15  # rods
_HOTTER = 3  # times the kinetic energy in the centre
_CLOSE = 1  # damping between a convex and a concave profile
_TURNING = Chain(size=60, restitution=1.05, damping=5.0)
TURNS_AT = 3.0  # the damping at which the kinetic equation's profile turns, as docs/chain stores


class Verdict(NamedTuple):
    """Whether a challenge is done, and what was found so far."""

    done: bool
    said: str


class Judge:
    """Looks at the chain of one page for one challenge."""

    def pushed(self, session: Session) -> None:
        """Note that the leftmost rod has just been pushed."""

    def follow(self, session: Session) -> None:
        """Look at the chain, in every frame."""

    def verdict(self, session: Session) -> Verdict:
        """Say what was found so far."""
        raise NotImplementedError


class PushJudge(Judge):
    """How fast the rightmost rod became after a push at the left end."""

    def __init__(self) -> None:
        self._found: dict[float, list[float]] = {1.0: [], 0.9: []}
        self._fastest, self._until, self._of = 0.0, -math.inf, Chain()
        self._seen, self._longest = 0.0, 0.0  # when it was last looked at, and how long that may be

    def pushed(self, session: Session) -> None:
        """Follow this push for twice the time that it takes through free space."""
        chain = session.chain
        space = chain.gap * (chain.size - 1) + 4 * chain.thermal_length
        self._fastest, self._of = 0.0, chain
        lasts = 2 * space / (KICK * chain.free_velocity_width)
        self._until, self._seen, self._longest = session.time + lasts, session.time, lasts / 10

    def follow(self, session: Session) -> None:
        """Note how fast the rightmost rod is, until the time of the push is over.

        A push is forgotten if the chain changes, or is now shown so fast that it would be missed.
        """
        missed = session.time > self._seen + self._longest
        if session.chain != self._of or session.diverged or missed:
            self._until = -math.inf
        self._seen = session.time
        if self._until == -math.inf:
            return
        self._fastest = max(self._fastest, session.v[-1] / session.chain.free_velocity_width)
        if session.time < self._until:
            return
        self._until = -math.inf
        if self._of.size >= 20 and self._of.restitution in self._found:
            self._found[self._of.restitution].append(self._fastest)

    def verdict(self, session: Session) -> Verdict:
        """Done when a push has arrived at e = 1, and one has not at e = 0.9."""
        elastic, lossy = (self._found[e] for e in (1.0, 0.9))
        done = any(v >= ARRIVED for v in elastic) and any(v < ARRIVED for v in lossy)
        words = [self._say(e) for e in self._found]
        words.append(f"A push has arrived if the last rod reaches {ARRIVED:g} W.")
        if done:
            words.append(
                "Elastic rods hand on all of a push. At e = 0.9 each collision keeps a part back."
            )
        return Verdict(done, " ".join(words))

    def _say(self, e: float) -> str:
        found = self._found[e]
        if not found:
            return f"e = {e:g}: no push has ended yet."
        arrived = sum(v >= ARRIVED for v in found)
        return (
            f"e = {e:g}: {arrived} of {len(found)} arrived; the last rod reached {found[-1]:.1f} W."
        )


class RunawayJudge(Judge):
    """The fewest rods of a chain that ran away."""

    def __init__(self) -> None:
        self._fewest = math.inf

    def verdict(self, session: Session) -> Verdict:
        """Done when a chain of so few rods has run away at e > 1."""
        chain = session.chain
        if session.diverged and chain.restitution > 1:
            self._fewest = min(self._fewest, chain.size)
            now = f"{chain.size} rods have run away"
        else:
            free = chain.size * chain.temperature
            growth = 2 * session.kinetic_energy / free
            now = f"the kinetic energy is {growth:.2g} times that of free rods"
        words = [f"Now {now}."]
        if self._fewest < math.inf:
            words.append(f"Fewest so far: {self._fewest}.")
        done = self._fewest <= _FEW
        if done and chain.restitution > 1 and chain.spring == "linear" and chain.gap == 0:
            critical = weak_damping_critical_size(chain)
            words.append(
                "Theory, for weak damping: more than π γ/((e − 1)√(km)) = "
                f"{critical:.2g} rods run away."
            )
        return Verdict(done, " ".join(words))


class BorderJudge(Judge):
    """Whether the outermost rods are hotter than the middle ones."""

    def __init__(self) -> None:
        self._ratio = EnergyRatio()
        self._best: tuple[float, float] | None = None

    def follow(self, session: Session) -> None:
        """Measure the ratio."""
        self._ratio.follow(session)

    def verdict(self, session: Session) -> Verdict:
        """Done when the ratio is above its goal by three standard errors."""
        known = self._ratio.known
        if known is not None and known[0] - _SURE * known[1] > _HOTTER:
            self._best = known
        words = f"Now {self._ratio.say(session)}."
        if self._best is None:
            words += f" It counts when it is clearly above {_HOTTER}: by {_SURE} standard errors."
        else:
            words += (
                f" Done: {self._best[0]:.1f} ± {self._best[1]:.1f}. Rods in the middle meet more "
                "neighbours, and each collision takes energy."
            )
        return Verdict(self._best is not None, words)


class TurningJudge(Judge):
    """Between which dampings the profile of velocity widths turns from concave to convex."""

    def __init__(self) -> None:
        self._ratio = EnergyRatio()
        self._convex, self._concave = -math.inf, math.inf

    def follow(self, session: Session) -> None:
        """Measure the ratio."""
        self._ratio.follow(session)

    def verdict(self, session: Session) -> Verdict:
        """Done when a convex and a concave profile have dampings at most 1 apart."""
        chain, known = session.chain, self._ratio.known
        # The amplitude only sets the scale of velocities.
        same = chain.replace(damping=5.0, amplitude=1.0) == _TURNING
        if same and known is not None:
            off = (known[0] - 1) / known[1]
            if off > _SURE:
                self._convex = max(self._convex, chain.damping)
            if off < -_SURE:
                self._concave = min(self._concave, chain.damping)
        kinds = {"convex": self._convex, "concave": self._concave}
        found = [f"{name} at γ = {at:g}" for name, at in kinds.items() if math.isfinite(at)]
        now = f"Now {self._ratio.say(session)}."
        words = now if same else "Another chain than that of the challenge."
        words += f" Found: {', '.join(found) or 'nothing yet'}."
        done = 0 < self._concave - self._convex <= _CLOSE + 1e-9
        if done:
            words += f" Theory: it turns at γ = {TURNS_AT:g}."
        return Verdict(done, words)


@dataclass(frozen=True)
class Challenge:
    """A task, and the chain and speed [T per second] that it begins with."""

    title: str
    ask: str
    chain: Chain
    speed: float
    new_judge: Callable[[], Judge]


CHALLENGES = (
    Challenge(
        "A push",
        "Push the left end, once at e = 1 and once at e = 0.9. Does the push arrive at the right "
        "end?",
        Chain(size=20, damping=0.3, gap=0.5),
        3,
        PushJudge,
    ),
    Challenge(
        "Run away",
        f"Above e = 1 each collision adds energy. Make the chain run away with {_FEW} rods or "
        "fewer. What takes the energy out again?",
        Chain(size=40, restitution=1.02),
        30,
        RunawayJudge,
    ),
    Challenge(
        "Hot ends",
        f"Make the two outermost rods hotter than the centre: {_HOTTER} times the kinetic energy. "
        "What decides how much a collision takes?",
        Chain(size=20, restitution=0.9),
        300,
        BorderJudge,
    ),
    Challenge(
        "Convex or concave",
        "With this damping the middle is hottest: a concave profile of velocity widths. Find two "
        f"dampings, at most {_CLOSE} apart, between which it turns convex, with hotter ends.",
        _TURNING,
        300,
        TurningJudge,
    ),
)

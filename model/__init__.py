"""The chain itself: parameters, units, derived scales, the vocabulary of results, files."""

from crazybilliards.model.chain import Chain
from crazybilliards.model.storage import load, save
from crazybilliards.model.vocabulary import chain_of

__all__ = ["Chain", "chain_of", "load", "save"]

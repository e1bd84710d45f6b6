"""The paper, arXiv:1404.7460, reproduced: its figures and claims.

``figures`` has one module for each kind of figure, and ``claims`` compares what they find with what
is claimed. The other modules hold what several figures share: fits, chains, distributions,
profiles. ``crazybilliards reproduce`` runs it all.
"""

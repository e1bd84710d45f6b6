"""The paper, arXiv:1404.7460, reproduced: its figures and claims.

``figures`` has one module for each figure of the paper, and ``claims`` compares what they find with
what is claimed. ``fits`` and the other modules hold what several figures share: fits, chains,
predictions.
``crazybilliards reproduce`` runs it all.
"""

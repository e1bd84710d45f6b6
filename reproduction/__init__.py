"""The paper, arXiv:1404.7460, reproduced: its figures and claims.

``figures`` has one module for each figure of the paper, and ``claims`` compares what they find with
what is claimed. The other modules hold the chains, fits and predictions that several figures share.
``crazybilliards reproduce`` runs it all.
"""

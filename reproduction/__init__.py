"""The paper, arXiv:1404.7460, reproduced: its figures and claims, and studies beyond it.

``figures`` has one module for each figure of the paper and ``beyond`` one for each further study.
``claims`` compares what they find with what is claimed. The modules beside these folders hold the
chains, fits and predictions that several figures share. ``crazybilliards reproduce`` runs it all.
"""

"""The paper, arXiv:1404.7460: its figures, and the chains that they share."""

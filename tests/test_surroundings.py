"""What surrounds a program: home folders, numpy's settings, archives, scripts, units, quotas."""

"""The kinetic equation of rods that have hit one another before: pair correlations."""

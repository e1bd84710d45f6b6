"""From the density of points, which every theory has, to the rods."""

"""The stationary force balance for the density rho(x), and its closures."""

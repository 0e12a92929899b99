// Every parameter of paper and ink: PARAMETER(id, unit, low, high, default, meaning). From this table come
// PaperSpec, the keys of share/papers/*.toml and their ranges, and docs/kernels.md's list.
// The defaults are Xuan paper with freshly ground ink; letters in brackets are Chu's (thesis 3.6 to 3.8).

// Water
PARAMETER(capacity, "µl/mm²", 0.005, 2, 0.06, "water that saturates the paper (rho = 1)")
PARAMETER(viscosity, "mm²/s", 0.002, 20, 0.6, "of the water where nothing blocks it; sets omega")
PARAMETER(advection, "1", 0.05, 1, 0.3, "saturation above which inertia has its full weight (alpha)")
PARAMETER(evaporation, "µl/(mm²·s)", 0, 0.1, 0.0015, "from wet paper (eps_s)")
PARAMETER(edge_evaporation, "µl/(mm·s)", 0, 0.01, 0.00015, "more at a pinned edge, per length of edge (eps_b)")

// Permeability: kappa = k1 + k2·G + k3·A + k4·g + k5·h, 0 free and 1 blocked
PARAMETER(block_base, "1", 0, 1, 0.2, "blocking of the bare paper (k1)")
PARAMETER(block_grain, "1", 0, 1, 0.5, "blocking by the grain texture (k2)")
PARAMETER(block_alum, "1", 0, 1, 0.5, "blocking by alum (k3)")
PARAMETER(block_glue, "1", 0, 1, 0.5, "blocking by glue in the water (k4)")
PARAMETER(block_fixed, "1", 0, 1, 0.15, "blocking by ink fixed in the paper (k5)")

// Pinning: a front enters a dry cell where rho >= sigma = q1 + q2·h + q3·lerp(G, P, smoothstep(0, theta, g))
PARAMETER(pin_base, "1", 0.001, 2, 0.09, "threshold of bare paper (q1)")
PARAMETER(pin_fixed, "1", 0, 5, 0.1, "threshold by ink fixed in the wet cell (q2)")
PARAMETER(pin_texture, "1", 0, 5, 0.8, "threshold by the textures (q3)")
PARAMETER(toe_glue, "1", 0, 2, 0.3, "glue at which the pinning texture replaces the grain (theta)")

// Pigment
PARAMETER(hindrance, "1", 0, 1, 0.45, "share of the pigment that the paper holds back (gamma)")
PARAMETER(hindrance_speed, "mm/s", 0, 10, 0.05, "speed of the water below which it holds back more (varsigma)")
PARAMETER(fix_base, "1/s", 0, 10, 0.03, "share of the pigment fixed in a second, at least (eta)")
PARAMETER(fix_dryness, "1", 0, 1, 0.8, "saturation below which drying fixes pigment (mu)")
PARAMETER(fix_glue, "1", 0, 1, 0.3, "raises it by the glue (xi)")

// Deposit
PARAMETER(receptivity, "1", 0.05, 10, 1, "saturation at which the paper takes least (lambda)")
PARAMETER(receptivity_floor, "1", 0, 1, 0.4, "share that it takes even then (m)")
PARAMETER(film, "µl/mm²", 0, 2, 0.058, "left by a full brush on newly covered dry paper")
PARAMETER(standing, "µl/mm²", 0, 2, 0.06, "standing on the paper in balance with a full brush that rests there")
PARAMETER(exchange, "1/s", 0, 1000, 1.5, "rate of that balance")

// Textures; lengths are those of the fibres in the sheet, whatever the cell
PARAMETER(fibre_length, "mm", 0.2, 20, 3.5, "mean length of a fibre")
PARAMETER(fibre_width, "mm", 0.02, 2, 0.24, "width of a fibre")
PARAMETER(fibre_density, "1/mm²", 0, 20, 0.8, "fibres that begin in a square millimetre")
PARAMETER(cloud_size, "mm", 0.2, 50, 3, "size of the thick and thin places of the sheet")
PARAMETER(cloud_share, "1", 0, 1, 0.35, "their share of the grain; the rest is fibres")
PARAMETER(pin_length, "mm", 0.2, 20, 2, "mean length of a segment of the pinning texture")
PARAMETER(pin_width, "mm", 0.02, 2, 0.14, "width of a segment")
PARAMETER(pin_density, "1/mm²", 0, 20, 1.2, "segments that begin in a square millimetre")
PARAMETER(alum_density, "1/mm²", 0, 20, 0, "dots of alum in a square millimetre")
PARAMETER(alum_size, "mm", 0.02, 5, 0.3, "diameter of a dot")

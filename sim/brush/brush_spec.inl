// Every parameter of a brush, once: BRUSH_PARAMETER(id, unit, minimum, maximum, default, meaning) and
// BRUSH_SWITCH(id, default, meaning). The struct, the TOML reader and docs/brush.md come from here.
// Forces are in millinewtons, so an energy in mN·mm is a microjoule.

// Shape at rest
BRUSH_PARAMETER(segments, "count", 3, 8, 6, "segments of the spine")
BRUSH_PARAMETER(segment_ratio, "1", 0.5, 1, 0.78, "length of a segment over the one above it")
BRUSH_PARAMETER(tuft_length_mm, "mm", 5, 120, 32, "length of the hair outside the ferrule")
BRUSH_PARAMETER(root_radius_mm, "mm", 0.5, 25, 3.6, "radius where hair leaves the ferrule")
BRUSH_PARAMETER(belly_radius_mm, "mm", 0.5, 25, 4.2, "largest radius of the wet, unbent tuft")
BRUSH_PARAMETER(belly_at, "1", 0.05, 0.8, 0.3, "where the belly is: 0 root, 1 tip")
BRUSH_PARAMETER(taper, "1", 0.6, 3, 1.5, "1 tapers as a cone from belly to tip; more keeps the belly longer")
BRUSH_PARAMETER(tip_radius_mm, "mm", 0.02, 5, 0.08, "radius at the very tip")
BRUSH_PARAMETER(lowest_root, "1", 0.1, 0.9, 0.2, "lowest height of the root over the paper, over the length; the hand stops there")
BRUSH_PARAMETER(contact_share, "1", 0.2, 0.95, 0.5, "shrunk section that the paper stops, over the full one")
BRUSH_PARAMETER(lateral_share, "1", 0.1, 0.9, 0.7, "effective radius of a lateral node over that of its spine node")

// Tufts side by side
BRUSH_PARAMETER(spines, "count", 1, 16, 1, "tufts side by side in a wet brush: 1 a round one, more a row of them, each a slice of the breadth")
BRUSH_PARAMETER(row_width_mm, "mm", 1, 150, 25, "breadth of the row at the ferrule; the radii of a row are half its thickness")
BRUSH_PARAMETER(row_coherence, "1", 0, 20, 3, "stiffness with which the tufts of a row bend as their neighbours do, over that of bending")
BRUSH_PARAMETER(fan_rad, "rad", 0, 1.2, 0, "angle to either side by which the outermost tufts of a row lean away")
BRUSH_PARAMETER(unruly_rad, "rad", 0, 0.6, 0, "angle to which the tufts of a row stand away at random, from the seed: a worn brush")

// Springs: energy (k/m)|x|^m
BRUSH_PARAMETER(spring_exponent, "1", 2, 3, 2, "m, of the bend, twist and stretch springs")
BRUSH_PARAMETER(bend_stiffness, "mN mm2", 10, 1e7, 180000, "of the tuft at its root, times radians per mm of curvature")
BRUSH_PARAMETER(stiffness_fall, "1", 0, 6, 2.8, "stiffness goes as the length below to this power: the core of a tuft is made of shorter hair")
BRUSH_PARAMETER(side_bend_ratio, "1", 1, 20, 2.5, "stiffness against bending along the lateral line")
BRUSH_PARAMETER(twist_ratio, "1", 0.05, 20, 0.8, "twist stiffness over bend stiffness; none at the root")
BRUSH_PARAMETER(stretch_stiffness, "mN/mm", 0.1, 1e4, 35, "of a lateral node's stretch spring at the belly")
BRUSH_PARAMETER(side_hair_stiffness, "mN mm", 0, 1e5, 60, "of the hair along the sides against a change of slope")
BRUSH_PARAMETER(spread_press, "1", 0, 3, 0.3, "rest stretch over radius of a submerged, unbent segment")
BRUSH_PARAMETER(spread_bend, "1", 0, 3, 0.9, "and what a sharp bend adds to it")
BRUSH_PARAMETER(spread_half_bend_rad, "rad", 0.01, 2, 0.35, "bend at which half of that is reached")
BRUSH_PARAMETER(spread_limit, "1", 0.1, 5, 1.6, "largest stretch over radius")

// Friction
BRUSH_PARAMETER(friction_along, "1", 0, 3, 0.2, "coefficient along the hair")
BRUSH_PARAMETER(friction_across, "1", 0, 3, 0.35, "coefficient across the hair")
BRUSH_PARAMETER(friction_slip_mm, "mm", 0.005, 1, 0.08, "epsilon: the slip over which friction builds up")
BRUSH_PARAMETER(adhesion_mn, "mN", 0, 100, 2.0, "wet adhesion of a fully submerged node, added to its reaction")
BRUSH_PARAMETER(reaction_lag_s, "s", 0, 0.1, 0.008, "time over which friction and spreading follow a change of contact")
BRUSH_PARAMETER(internal_friction_s, "s", 0, 1, 0.012, "time in which a bent tuft springs back, under water")

// Plasticity (Chu 2.5.5)
BRUSH_PARAMETER(plasticity_rad, "rad", 0, 1, 0.06, "alpha: the bend of a joint that a wet tuft keeps")
BRUSH_PARAMETER(plasticity_rate_per_s, "1/s", 0, 1000, 12, "how fast the springs shift to the present bend")

// Pores (Chu 2.5.6): L = lead + tilt_lead max(tilt - critical, 0) + pressure_lead pressure
BRUSH_PARAMETER(pore_lead_mm, "mm", 0, 10, 0.15, "L of an upright tip with no pressure")
BRUSH_PARAMETER(pore_tilt_lead_mm, "mm/rad", 0, 100, 6, "a: what tilt beyond the critical angle adds")
BRUSH_PARAMETER(pore_pressure_lead_mm, "mm/mN", 0, 1, 0.004, "b: what pressure on the tip adds")
BRUSH_PARAMETER(pore_critical_tilt_rad, "rad", 0, 1.57, 0.7, "gamma: within it the tip is trapped")
BRUSH_PARAMETER(pore_strength_mn, "mN", 0.1, 1e4, 12, "force at which the tip jumps to the next pore")

// Ink in the tuft
BRUSH_PARAMETER(capacity_ul, "ul", 1, 5000, 160, "water in a full tuft")
BRUSH_PARAMETER(moisture_flow_per_s, "1/s", 0, 50, 1.5, "how fast moisture evens out; along the hair a full tuft could empty itself so often")
BRUSH_PARAMETER(inward_flow_per_s, "1/s", 0, 50, 8, "how fast the inside of the tuft and its surface even out")
BRUSH_PARAMETER(pigment_spread_mm2_per_s, "mm2/s", 0, 10, 0.05, "how fast pigment spreads in wet hair that rests")
BRUSH_PARAMETER(absorbency_per_s, "1/s", 0.1, 100, 6, "how fast hair takes up what it stands in, and gives up to a cloth")
BRUSH_PARAMETER(soak_mm, "mm", 0, 3, 0.35, "how far ink swells a soaked tuft; less as it dries")
BRUSH_PARAMETER(hair_count, "count", 8, 2000, 220, "hair bundles around the tuft, for streaks")
BRUSH_PARAMETER(streak_wetness, "1", 0, 1, 0.45, "wetness below which the lower hair leaves no ink")
BRUSH_PARAMETER(streak_press, "1", 0, 1, 0.5, "how much of that firm pressure brings back: 1 all, whatever it holds")
BRUSH_PARAMETER(streak_half_mn_mm, "mN/mm", 0.1, 1000, 10, "pressure along the tuft at which half of it is back")
BRUSH_PARAMETER(split_open, "1", 0, 1, 0.9, "how far splits open in a dry tuft that is spread to its width again")
BRUSH_PARAMETER(split_shift_mm, "mm", 0, 60, 8, "by which a soaked tip moves its splits on, beyond the tip")
BRUSH_PARAMETER(grain, "1", 0, 1, 0.75, "share of the paper, its hollows, that nearly dry hair passes over")

// Footprint and time
BRUSH_PARAMETER(cell_mm, "mm", 0.01, 1, 0.05, "cell of the footprint map")
BRUSH_PARAMETER(longest_step_s, "s", 0.0005, 0.1, 0.001, "a longer frame is solved in steps")
BRUSH_PARAMETER(iteration_limit, "count", 1, 200, 20, "of the solver, in one step")

BRUSH_SWITCH(spread, true, "lateral nodes move: the tuft flattens and spreads")
BRUSH_SWITCH(plasticity, true, "the tuft keeps some of its bend")
BRUSH_SWITCH(pore_resistance, true, "pores of the paper hold a pushed tip")
BRUSH_SWITCH(friction_anisotropy, true, "friction differs along and across the hair")
BRUSH_SWITCH(section_contact, true, "the paper stops the shrunk section; off: only the spine")
BRUSH_SWITCH(hair_texture, true, "a drying tuft leaves streaks")
BRUSH_SWITCH(split_map, true, "hair parts where the tuft spreads")
BRUSH_SWITCH(grain_mask, true, "dry hair touches only the hills of the paper")

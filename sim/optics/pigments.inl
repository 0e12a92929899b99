// FUDE_PIGMENT(name, K red, K green, K blue, S red, S green, S blue): of the unit layer of pigment.h.
// Chinese ink is soot in glue: it absorbs all but evenly, blue a little more (it dries warm), and hardly
// scatters. Ours: one unit layer is black, a tenth of one a middle grey.
FUDE_PIGMENT("sumi", 5.00, 5.20, 5.53, 0.040, 0.037, 0.033)
// Curtis et al. 1997, figure 5, at second hand: as several independent implementations give them.
FUDE_PIGMENT("quinacridone-rose", 0.22, 1.47, 0.57, 0.05, 0.003, 0.03)
FUDE_PIGMENT("indian-red", 0.46, 1.07, 1.50, 1.28, 0.38, 0.21)
FUDE_PIGMENT("cadmium-yellow", 0.10, 0.36, 3.45, 0.97, 0.65, 0.007)
FUDE_PIGMENT("hookers-green", 1.62, 0.61, 1.64, 0.01, 0.012, 0.003)
FUDE_PIGMENT("cerulean-blue", 1.52, 0.32, 0.25, 0.06, 0.26, 0.40)
FUDE_PIGMENT("burnt-umber", 0.74, 1.54, 2.10, 0.09, 0.09, 0.004)
FUDE_PIGMENT("cadmium-red", 0.14, 1.08, 1.68, 0.77, 0.015, 0.018)
FUDE_PIGMENT("brilliant-orange", 0.13, 0.81, 3.45, 0.005, 0.009, 0.007)
FUDE_PIGMENT("hansa-yellow", 0.06, 0.21, 1.78, 0.50, 0.88, 0.009)
FUDE_PIGMENT("phthalo-green", 1.55, 0.47, 0.63, 0.01, 0.05, 0.035)
FUDE_PIGMENT("french-ultramarine", 0.86, 0.86, 0.06, 0.005, 0.005, 0.09)
FUDE_PIGMENT("interference-lilac", 0.08, 0.11, 0.07, 1.25, 0.42, 1.43)

// Wacom tablets by USB product where the driver states no resolution: first and last product, counts
// per mm, family. The figures are Wacom's lines per inch (508, 1016, 1270, 2032, 2540, 5080).
// A product in no row has 200, as Wacom's professional tablets have had since the Intuos3.
TABLET_MODELS(0x0000, 0x0000, 40, "PenPartner")
TABLET_MODELS(0x0010, 0x0016, 80, "Graphire, Graphire2, Graphire3, Graphire4")
TABLET_MODELS(0x0017, 0x0018, 100, "Bamboo Fun")
TABLET_MODELS(0x0020, 0x0024, 100, "Intuos")
TABLET_MODELS(0x0030, 0x0035, 20, "PL")
TABLET_MODELS(0x0041, 0x0045, 100, "Intuos2")
TABLET_MODELS(0x0060, 0x0060, 50, "Volito")

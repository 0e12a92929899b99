// Polhemus's trackers on USB: product, name, dialect, stations, endpoints.
POLHEMUS_MODEL(0x0002, "FASTRAK", fastrak, /*stations=*/4, /*in=*/0x88, /*out=*/0x04)
POLHEMUS_MODEL(0x0003, "FASTRAK (2012)", fastrak, /*stations=*/4, /*in=*/0x88, /*out=*/0x04)
POLHEMUS_MODEL(0xef12, "PATRIOT", liberty, /*stations=*/2, /*in=*/0x88, /*out=*/0x04)
POLHEMUS_MODEL(0xef20, "PATRIOT HS", liberty, /*stations=*/2, /*in=*/0x88, /*out=*/0x04)
POLHEMUS_MODEL(0xff12, "LIBERTY", liberty, /*stations=*/16, /*in=*/0x88, /*out=*/0x04)
POLHEMUS_MODEL(0xff20, "LIBERTY HS", liberty, /*stations=*/16, /*in=*/0x88, /*out=*/0x04)

// Nintendo's controllers that speak the Joy-Con's protocol: product, name, and what one count is without
// a calibration (firmware-notes/joycon.md).
JOYCON_MODEL(0x2006, "Joy-Con (L)", /*acceleration_g=*/0.000244, /*turn_rate_degps=*/0.06103)
JOYCON_MODEL(0x2007, "Joy-Con (R)", /*acceleration_g=*/0.000244, /*turn_rate_degps=*/0.06103)
JOYCON_MODEL(0x2009, "Pro Controller", /*acceleration_g=*/0.000244, /*turn_rate_degps=*/0.06103)

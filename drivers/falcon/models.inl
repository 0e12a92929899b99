// Novint's arms: product, name, greatest force, motor counts a newton metre at a leg and their limit, middle
// of the workspace before the base. The counts are libnifalcon's figure (firmware-notes/falcon.md).
FALCON_MODEL(0xcb48, "Falcon", /*force_n=*/8.0, /*motor_counts_per_nm=*/10000, /*motor_limit_counts=*/4096,
             /*middle_m=*/0.125)

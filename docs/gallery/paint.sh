#!/bin/sh
# Paints every picture of the gallery again. The recordings of real tablets are taken from the folder
# that FUDE_RECORDINGS names, and left out where there is none.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
fude=$root/build/release/fude
here=$root/docs/gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

paint() { # SESSION PICTURE OPTIONS…
  session=$1 picture=$2
  shift 2
  "$fude" replay "$session" --out "$here/$picture" --depth 8 --force "$@"
}

paint "$root/share/sessions/yong.fude" yong.png --settle 4
paint "$root/share/sessions/bamboo.fude" bamboo.png --settle 6 --cell-mm 0.2
"$fude" perform turns --out "$work/turns.fude"
paint "$work/turns.fude" turns.png --flow off
for brush in "$here"/brushes/*.toml; do
  paint "$work/turns.fude" "turns-$(basename "$brush" .toml).png" --flow off --brush "$brush"
done
"$fude" perform brushwork --out "$work/brushwork.fude"
paint "$work/brushwork.fude" brushwork.png --flow off --cell-mm 0.13
"$fude" perform petals --out "$work/petals.fude"
paint "$work/petals.fude" petals.png --cell-mm 0.15
"$fude" perform flat --out "$work/flat.fude"
paint "$work/flat.fude" flat.png --brush flat --manner upright --cell-mm 0.15
"$fude" brushes --out "$here/brushes.png" --force
"$fude" perform blots --out "$work/blots.fude"
for paper in xuan feathery light-fringe branching rough-edge dark-edge; do
  paint "$work/blots.fude" "blots-$paper.png" --paper "$paper" --settle 20
done

recordings=${FUDE_RECORDINGS:-$root/../shared/recordings}
[ -d "$recordings" ] || exit 0
real() { # FILE PICTURE OPTIONS…
  file=$1 picture=$2
  shift 2
  "$fude" import "$recordings/$file" --out "$work/$picture.fude"
  paint "$work/$picture.fude" "$picture.png" "$@"
}
real strokes/painting30sec.dat painting30sec
real evdev/Wacom_Cintiq_13HD.events.gz cintiq-13hd --cell-mm 0.2
real evdev/Wacom_Cintiq_12WX.events cintiq-12wx --cell-mm 0.2
real evdev/Wacom_Intuos4_6x9.stylus-drag.events intuos4-drag --cell-mm 0.2
real evdev/UC-LOGIC_Tablet_WP5540U_Pen.events uc-logic --cell-mm 0.2

// What healthy devices of each family send, report by report: for fakes, and for the lab's scripted devices.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/decoder.h"

namespace fude {

// fude's brush handle: its scale (a feature report), and motion number `i`, a millisecond apart.
std::vector<std::byte> handle_scale();
std::vector<std::byte> handle_motion(unsigned i);
// 3Dconnexion: push and turn in one report, of the newer models.
std::vector<std::byte> spacemouse_motion(unsigned i);
// Polhemus PATRIOT: station 1's record of frame `i`, in the layout that the driver asks for.
std::vector<std::byte> patriot_record(unsigned i);
// Novint Falcon: what its firmware answers, all legs homed, without the serial chip's status.
std::vector<std::byte> falcon_answer(unsigned i);
// fude's ultrasonic board: pulse number `i`, framed.
std::vector<std::byte> ultrasonic_pulse(unsigned i);

// A Joy-Con's full report: three readings of gravity and a turn. Byte 1 is its timer.
std::vector<std::byte> joycon_report(unsigned i);
// P5 Glove: bends that change, one light that moves.
std::vector<std::byte> glove_report(unsigned i);
// Raw reports of pens that draw: an Intuos Pro's behind the one that tells its tool, a Huion's, and those of
// any that follow the standard, number 7, by this descriptor.
std::vector<std::byte> intuos_enter();
std::vector<std::byte> intuos_report(unsigned i);
std::vector<std::byte> huion_report(unsigned i);
std::vector<std::byte> standard_pen_descriptor();
std::vector<std::byte> standard_pen_report(unsigned i);
// Frames of the kernel: a pen that draws, a finger that slides; both are there from frame 0 on.
std::vector<std::byte> pen_frame(unsigned i);
std::vector<std::byte> touch_frame(unsigned i);
// A TRANSFORM of OpenIGTLink; a Pos_Quat of VRPN from sender 0 and of type 0.
std::vector<std::byte> transform_message(unsigned i);
std::vector<std::byte> pos_quat_message(unsigned i);

struct FamilyStream {
  std::string name;
  std::function<std::unique_ptr<Decoder>()> decoder;
  std::vector<Transfer> introduction;  // answers to the greeting, without which the driver waits
  std::vector<Transfer> reports;       // four milliseconds apart
  bool in_bytes = false;     // reports are bytes of a stream: neither beginning nor end means anything
  unsigned samples = 1;      // that each report gives
  bool from_kernel = false;  // which may lose frames but writes no garbage
};

// Of all of the above.
std::vector<FamilyStream> family_streams(unsigned reports);

}  // namespace fude

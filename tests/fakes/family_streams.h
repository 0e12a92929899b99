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

struct FamilyStream {
  std::string name;
  std::function<std::unique_ptr<Decoder>()> decoder;
  std::vector<Transfer> introduction;  // answers to the greeting, without which the driver waits
  std::vector<Transfer> reports;       // four milliseconds apart; each gives one sample
  bool in_bytes = false;  // reports are bytes of a stream: neither beginning nor end means anything
};

// Of all of the above.
std::vector<FamilyStream> family_streams(unsigned reports);

}  // namespace fude

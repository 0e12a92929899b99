// Which of the streams that come in a calibration means: the one of a name, or the only one.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "capture/session.h"
#include "signal/device.h"
#include "signal/result.h"
#include "signal/sample.h"

namespace fude {

struct StreamWish {
  // Of a device ("Polhemus Fastrak"), of a tool ("brush", "Polhemus Fastrak/brush"), of a kind ("imu"), or of
  // both ("Joy-Con imu"); "NAME #2" is the device of that number. Empty: the only one.
  std::string name;
  std::string what = "tool";                 // as messages call it
  std::string option = "--tool";             // by which it is named
  std::function<bool(const Sample&)> kinds;  // that count; empty: all
  std::string but;                           // the name of a stream that is not meant
};

struct ChosenStream {
  DeviceNumber number = 0;
  DeviceDescription device;
  std::string part;  // tool or marker
};

class StreamChoice {
 public:
  explicit StreamChoice(StreamWish wish) : wish_(std::move(wish)) {}

  void begin(DeviceNumber device, const DeviceDescription& description);

  // Whether the sample is of that stream. Errors: not_found, naming both, where a second one fits.
  Result<bool> takes(DeviceNumber device, const Sample& sample);

  // None until it was heard.
  const std::optional<ChosenStream>& chosen() const { return chosen_; }

  // Errors: not_found where none was heard, naming those that were.
  Result<ChosenStream> found() const;

 private:
  using Key = std::tuple<DeviceNumber, std::size_t, std::string>;
  Result<bool> decide(const Key& key, const Sample& sample);

  StreamWish wish_;
  std::map<DeviceNumber, DeviceDescription> devices_;
  std::map<Key, bool> decided_;
  std::vector<std::string> heard_;  // of the kinds that count
  std::optional<ChosenStream> chosen_;
};

// Whether `name` means the stream of that sample, in one of the ways of StreamWish::name.
bool names_stream(const std::string& name, DeviceNumber number, const DeviceDescription& device,
                  const Sample& sample);

template <class Kind>
bool is_kind(const Sample& sample) {
  return std::holds_alternative<Kind>(sample);
}

}  // namespace fude

#include "rig/calibration/stream_choice.h"

#include <variant>

#include "capture/sample_columns.h"

namespace fude {

bool names_stream(const std::string& name, DeviceNumber number, const DeviceDescription& device,
                  const Sample& sample) {
  const std::string& kind = sample_tables()[sample.index()].stream;
  const std::string part = part_of(sample);
  if (name.empty() || name == kind || name == part) return !name.empty();
  for (const std::string& label : {device.name, device.name + " #" + std::to_string(number)})
    for (const std::string& stream : {label, label + " " + kind})
      if (name == stream || name == stream + "/" + part) return true;
  return false;
}

void StreamChoice::begin(DeviceNumber device, const DeviceDescription& description) {
  devices_[device] = description;
}

Result<bool> StreamChoice::takes(DeviceNumber device, const Sample& sample) {
  Key key{device, sample.index(), part_of(sample)};
  if (const auto known = decided_.find(key); known != decided_.end()) return known->second;
  const auto taken = decide(key, sample);
  if (taken) decided_.emplace(std::move(key), *taken);
  return taken;
}

Result<bool> StreamChoice::decide(const Key& key, const Sample& sample) {
  if (wish_.kinds && !wish_.kinds(sample)) return false;
  const auto& [number, kind, part] = key;
  const DeviceDescription& device = devices_[number];
  const bool other = wish_.name.empty() ? names_stream(wish_.but, number, device, sample)
                                        : !names_stream(wish_.name, number, device, sample);
  const std::string label = part.empty() ? device.name : part;
  heard_.push_back(label);
  if (other) return false;
  if (chosen_) {
    const std::string first = chosen_->part.empty() ? chosen_->device.name : chosen_->part;
    const bool alike = first == label;  // by name: the device's number then tells them apart
    const auto told = [&](const std::string& name, DeviceNumber of) {
      return alike ? name + " #" + std::to_string(of) : name;
    };
    return failure(Fault::not_found, "the session has several " + wish_.what + "s: name one with " +
                                         wish_.option + " (" + told(first, chosen_->number) + ", " +
                                         told(label, number) + ")");
  }
  chosen_ = ChosenStream{number, device, part};
  return true;
}

Result<ChosenStream> StreamChoice::found() const {
  if (chosen_) return *chosen_;
  std::string there;
  for (const std::string& name : heard_) there += (there.empty() ? "" : ", ") + name;
  if (wish_.name.empty() && there.empty())
    return failure(Fault::not_found, "no " + wish_.what + " was heard; does the session hold one?");
  if (wish_.name.empty())
    return failure(Fault::not_found, "there is no other " + wish_.what + " than " + there);
  return failure(Fault::not_found, "there is no " + wish_.what + " '" + wish_.name.substr(0, 80) + "'; " +
                                       (there.empty() ? "none was heard" : "there is: " + there));
}

}  // namespace fude

#include "capture/streams.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace fude {
namespace {

constexpr std::size_t most_named = 40;

std::string device_name(const Session& session, DeviceNumber number) {
  std::string name;
  int alike = 0;
  for (const RecordedDevice& device : session.devices)
    if (device.number == number) name = device.description.name;
  for (const RecordedDevice& device : session.devices) alike += device.description.name == name;
  if (name.empty()) name = "device";
  return alike == 1 ? name : name + " #" + std::to_string(number);
}

}  // namespace

std::vector<SessionStream> streams_of(const Session& session) {
  using Key = std::tuple<DeviceNumber, std::size_t, std::string>;
  std::map<Key, std::size_t> places;
  std::vector<SessionStream> streams;
  const auto add = [&](DeviceNumber device, std::size_t kind, std::string part, std::size_t at) {
    const auto [place, added] = places.try_emplace({device, kind, part}, streams.size());
    if (added) streams.push_back({{}, device, kind, std::move(part), {}});
    streams[place->second].samples.push_back(at);
  };
  constexpr std::size_t pens = 0;
  for (std::size_t i = 0; i < session.pens.size(); ++i) add(session.pens[i].device, pens, {}, i);
  for (std::size_t i = 0; i < session.samples.size(); ++i) {
    const RecordedSample& s = session.samples[i];
    add(s.device, s.sample.index(), part_of(s.sample), i);
  }
  std::stable_sort(streams.begin(), streams.end(), [](const SessionStream& a, const SessionStream& b) {
    return std::tie(a.device, a.kind) < std::tie(b.device, b.kind);
  });
  std::map<DeviceNumber, std::set<std::size_t>> kinds;
  std::map<std::pair<DeviceNumber, std::size_t>, int> parts;
  for (const SessionStream& s : streams) {
    kinds[s.device].insert(s.kind);
    ++parts[{s.device, s.kind}];
  }
  for (SessionStream& s : streams) {
    s.name = device_name(session, s.device);
    if (kinds[s.device].size() > 1) s.name += ' ' + sample_tables()[s.kind].stream;
    if (parts[{s.device, s.kind}] > 1) s.name += '/' + s.part;
  }
  return streams;
}

Result<SessionStream> find_stream(const Session& session, std::string_view name) {
  std::vector<SessionStream> streams = streams_of(session);
  const auto only = [&](auto fits) -> SessionStream* {
    const auto first = std::find_if(streams.begin(), streams.end(), fits);
    if (first == streams.end() || std::find_if(first + 1, streams.end(), fits) != streams.end())
      return nullptr;
    return &*first;
  };
  SessionStream* found = only([&](const SessionStream& s) { return s.name == name; });
  if (!found) found = only([&](const SessionStream& s) { return !s.part.empty() && s.part == name; });
  if (!found) found = only([&](const SessionStream& s) { return sample_tables()[s.kind].stream == name; });
  if (found) return std::move(*found);
  std::string there;
  for (std::size_t i = 0; i < streams.size() && i < most_named; ++i)
    there += (there.empty() ? "" : ", ") + streams[i].name;
  return failure(Fault::not_found, "the session has no stream '" + std::string(name.substr(0, 80)) + "'; " +
                                       (there.empty() ? "it holds no samples" : "it has: " + there));
}

Sample sample_at(const Session& session, const SessionStream& stream, std::size_t i) {
  const std::size_t at = stream.samples.at(i);
  if (std::holds_alternative<PenSample>(sample_tables()[stream.kind].blank)) return session.pens[at].sample;
  return session.samples[at].sample;
}

}  // namespace fude

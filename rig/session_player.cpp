#include "rig/session_player.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "capture/sample_columns.h"
#include "capture/streams.h"
#include "drivers/transport/evdev_state.h"
#include "drivers/transport/uinput_device.h"
#include "rig/recorded_driver.h"
#include "rig/session_summary.h"

namespace fude {
namespace {

constexpr Duration attendance = std::chrono::milliseconds(100);  // of those who want to connect
constexpr Duration patience = std::chrono::seconds(5);           // with those who read slowly

std::string named(const DeviceDescription& device) {
  return device.name.empty() ? "device " + device.id : device.name;
}

// What no description holds, once each.
std::vector<EvdevEvent> undescribed_events(std::span<const Transfer> transfers) {
  std::set<std::pair<std::uint16_t, std::uint16_t>> seen;
  std::vector<EvdevEvent> events;
  for (const Transfer& transfer : transfers) {
    if (transfer.kind != TransferKind::evdev_frame) continue;
    for (const EvdevEvent& event : unpack_events(transfer.payload).value_or(std::vector<EvdevEvent>{}))
      if ((event.type == EV_MSC || event.type == EV_REL || event.type == EV_SW) &&
          seen.insert({event.type, event.code}).second)
        events.push_back(event);
  }
  return events;
}

bool seen_by_tracker(const Sample& sample) {
  return std::holds_alternative<PoseSample>(sample) || std::holds_alternative<PositionSample>(sample);
}

}  // namespace

Result<LiveInput> make_uinput(const DeviceDescription& device, std::span<const EvdevEvent> also) {
  auto made = UinputDevice::create(device, also);
  if (!made) return tl::unexpected(made.error());
  const std::shared_ptr<UinputDevice> input = std::move(*made);
  return LiveInput{input->node(),
                   [input](std::span<const EvdevEvent> events) { return input->send(events); }};
}

struct SessionPlayer::Device {
  Device(const RecordedDevice& recorded, std::vector<Transfer> transfers, double speed,
         const std::shared_ptr<Clock>& clock, std::size_t stream_number)
      : number(recorded.number),
        description(recorded.description),
        driver(recorded.description, transfers),
        also(undescribed_events(transfers)),
        state(description),
        source(std::move(transfers), speed, clock),
        stream(stream_number) {}

  DeviceNumber number;
  DeviceDescription description;
  RecordedDriver driver;
  std::vector<EvdevEvent> also;
  EvdevState state;
  SessionSource source;
  std::size_t stream;  // in played_
  std::optional<LiveInput> input;
  bool wanted = false;  // as an input device
};

Result<std::unique_ptr<SessionPlayer>> SessionPlayer::open(Session session, const PlayWish& wish,
                                                           std::shared_ptr<Clock> clock,
                                                           MakeLiveInput make_input) {
  std::optional<DeviceNumber> device;
  std::string part;
  if (!wish.stream.empty()) {
    const auto named_so = [&](const RecordedDevice& d) { return d.description.name == wish.stream; };
    const auto found = std::find_if(session.devices.begin(), session.devices.end(), named_so);
    if (found != session.devices.end()) {
      device = found->number;
    } else {
      const auto stream = find_stream(session, wish.stream);
      if (!stream) return tl::unexpected(stream.error());
      device = stream->device;
      part = stream->part;
    }
  }
  const SessionSpan span = span_of(session);
  // Times may be anything: nothing here may go round.
  if (wish.from > Duration(0) &&
      (span.first > Timestamp::max() - wish.from || span.first + wish.from > span.last))
    return failure(Fault::usage, "the session ends " +
                                     std::to_string(seconds(span.last.time_since_epoch()) -
                                                    seconds(span.first.time_since_epoch())) +
                                     " s after its beginning; give an earlier --from");
  std::unique_ptr<SessionPlayer> player(
      new SessionPlayer(std::move(session), wish, std::move(clock), std::move(make_input)));
  for (const RecordedDevice& recorded : player->session_.devices)
    if (part.empty() && (!device || *device == recorded.number)) player->add_device(recorded);
  player->add_seen(device, part, wish.doors);
  if (player->devices_.empty() && player->seen_.empty())
    return failure(Fault::not_found,
                   (wish.stream.empty() ? "the session" : "'" + wish.stream + "'") +
                       std::string(" has nothing to play: no bytes of a device, no poses and no positions"));
  return player;
}

SessionPlayer::SessionPlayer(Session session, const PlayWish& wish, std::shared_ptr<Clock> clock,
                             MakeLiveInput make_input)
    : session_(std::move(session)),
      patient_(wish.speed == 0),
      clock_(patient_ ? std::make_shared<ManualClock>() : std::move(clock)),
      make_input_(std::move(make_input)) {
  if (!patient_) time_.speed = wish.speed;
  time_.recorded = Timestamp::min();
  if (wish.from <= Duration(0)) return;
  const Timestamp first = span_of(session_).first;
  time_.recorded = first + wish.from;
}

SessionPlayer::~SessionPlayer() = default;

void SessionPlayer::add_device(const RecordedDevice& recorded) {
  std::vector<Transfer> transfers = transfers_of(session_, recorded.number);
  if (transfers.empty()) return;
  played_.push_back({.name = named(recorded.description), .outlet = {}});
  devices_.push_back(
      std::make_unique<Device>(recorded, std::move(transfers), time_.speed, clock_, played_.size() - 1));
  Device& device = *devices_.back();
  device.wanted = recorded.description.transport == "evdev";
  if (device.wanted) make_input(device);
}

void SessionPlayer::add_seen(const std::optional<DeviceNumber>& device, const std::string& part,
                             const PoseServers::Doors& doors) {
  std::vector<std::string> names;
  std::map<std::pair<DeviceNumber, std::string>, Seen> known;
  for (const RecordedSample& recorded : session_.samples) {
    if (!seen_by_tracker(recorded.sample) || (device && *device != recorded.device)) continue;
    const std::string tool = part_of(recorded.sample);
    if (!part.empty() && tool != part) continue;
    const auto [served, added] =
        known.try_emplace({recorded.device, tool}, Seen{names.size(), played_.size(), nullptr});
    if (added) {
      const auto of_number = [&](const RecordedDevice& d) { return d.number == recorded.device; };
      const auto tracker = std::find_if(session_.devices.begin(), session_.devices.end(), of_number);
      std::string name = tool;
      if (name.empty() && tracker != session_.devices.end()) name = tracker->description.name;
      names.push_back(name.empty() ? "tool" : name);
      played_.push_back({.name = names.back(), .outlet = {}});
    }
    seen_.push_back({served->second.tool, served->second.stream, &recorded.sample});
  }
  if (seen_.empty()) return;
  std::stable_sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
    return time_of(*a.sample).host < time_of(*b.sample).host;
  });
  servers_ = std::make_unique<PoseServers>(doors);
  for (const std::string& name : names) servers_->add(name);
  for (const Error& error : servers_->refused()) notes_.push_back(error.message);
  std::string outlet;
  if (servers_->openigtlink())
    outlet = "OpenIGTLink 127.0.0.1:" + std::to_string(servers_->openigtlink()->port());
  if (servers_->vrpn())
    outlet += (outlet.empty() ? "" : ", ") + ("VRPN 127.0.0.1:" + std::to_string(servers_->vrpn()->port()));
  for (const auto& [key, served] : known) played_[served.stream].outlet = outlet;
}

void SessionPlayer::make_input(Device& device) {
  auto made = make_input_(device.description, device.also);
  if (!made) {
    device.wanted = false;
    notes_.push_back(played_[device.stream].name + " is not played as a device: " + made.error().message);
    return;
  }
  device.input = std::move(*made);
  played_[device.stream].outlet = device.input->node.empty() ? "uinput" : device.input->node;
}

bool SessionPlayer::stand(Duration duration, const std::function<bool()>& enough) {
  SystemClock machine;
  const Timestamp end = machine.now() + duration;
  for (Timestamp now = machine.now(); now < end && !(enough && enough()); now = machine.now()) {
    if (servers_) servers_->attend();
    if (!machine.wait(std::min(end, now + attendance), waker_) || stopping_) return false;
  }
  return !stopping_;
}

void SessionPlayer::stop() {
  stopping_ = true;
  waker_.wake();
}

// The recording runs through the driver as it will later; the kernel is told the outcome in one frame.
void SessionPlayer::lead_in(Device& device) {
  std::vector<Sample> unheard;
  bool away = false;
  while (device.source.leading()) {
    const auto read = device.source.read(std::nullopt);
    device.driver.decode(**read, unheard);
    unheard.clear();
    if ((*read)->kind == TransferKind::unplugged) {
      away = true;
      device.state.reset();
    } else if ((*read)->kind == TransferKind::plugged) {
      away = false;
    } else if ((*read)->kind == TransferKind::evdev_frame) {
      device.state.apply(unpack_events((*read)->payload).value_or(std::vector<EvdevEvent>{}));
    }
  }
  if (away) device.input.reset();
  send(device, device.state.frame());
}

bool SessionPlayer::play(const Heard& heard) {
  if (time_.recorded == Timestamp::min()) {
    time_.recorded = Timestamp::max();
    for (const auto& device : devices_)
      time_.recorded = std::min(time_.recorded, *device->source.next_time());
    if (!seen_.empty()) time_.recorded = std::min(time_.recorded, time_of(*seen_.front().sample).host);
  }
  time_.played = clock_->now();
  for (const auto& device : devices_) {
    device->source.seek(time_.recorded, time_.played);
    lead_in(*device);
  }
  const auto seen_at = [this] { return time_of(*seen_[next_seen_].sample).host; };
  while (next_seen_ < seen_.size() && seen_at() < time_.recorded) ++next_seen_;

  while (!stopping_) {
    Device* next = nullptr;
    for (const auto& device : devices_) {
      const auto time = device->source.next_time();
      if (time && (!next || *time < *next->source.next_time())) next = device.get();
    }
    const bool any_seen = next_seen_ < seen_.size();
    if (!next && !any_seen) break;
    const Timestamp seen_time = any_seen ? seen_at() : Timestamp::max();
    const Timestamp device_time = next ? *next->source.next_time() : Timestamp::max();
    if (!wait_until(std::min(seen_time, device_time))) continue;
    if (any_seen && (!next || seen_time < device_time))
      give(seen_[next_seen_++]);
    else
      give(*next, heard);
  }
  if (servers_) servers_->drain(patience);
  return !stopping_;
}

bool SessionPlayer::wait_until(Timestamp recorded) {
  const Timestamp due = time_.due(recorded);
  for (;;) {
    if (servers_) servers_->attend();
    const Timestamp next = std::min(due, clock_->now() + attendance);
    if (!clock_->wait(next, waker_)) return false;
    if (next == due) return true;
  }
}

void SessionPlayer::give(Device& device, const Heard& heard) {
  const auto read = device.source.read(clock_->now());
  if (!read || !*read) return;
  const Transfer& transfer = **read;
  PlayedStream& played = played_[device.stream];
  std::vector<Sample> samples;
  device.driver.decode(transfer, samples);
  ++played.given;
  played.samples += samples.size();
  if (heard) heard(device.number, transfer, samples);
  if (!device.wanted) return;
  if (transfer.kind == TransferKind::unplugged) {
    device.input.reset();
  } else if (transfer.kind == TransferKind::plugged && !device.input) {
    make_input(device);
  } else if (transfer.kind == TransferKind::evdev_frame) {
    send(device, unpack_events(transfer.payload).value_or(std::vector<EvdevEvent>{}));
  }
}

void SessionPlayer::send(Device& device, std::span<const EvdevEvent> events) {
  if (!device.input || events.empty()) return;
  if (const auto sent = device.input->send(events); !sent) {
    notes_.push_back(played_[device.stream].name + " is played no further: " + sent.error().message);
    device.input.reset();
    device.wanted = false;
  }
}

void SessionPlayer::give(const Seen& seen) {
  const Duration wait = patient_ ? patience : Duration(0);
  const auto serve = [&](const auto& sample) {
    servers_->send(seen.tool, sample, wait);
    played_[seen.stream].given += sample.valid;
  };
  if (const auto* pose = std::get_if<PoseSample>(seen.sample)) serve(*pose);
  if (const auto* position = std::get_if<PositionSample>(seen.sample)) serve(*position);
}

}  // namespace fude

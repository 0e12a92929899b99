// A session as live devices: what the kernel is told, and what clients on the network read.
#include "rig/session_player.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <tuple>

#include "drivers/openigtlink/openigtlink_decoder.h"
#include "drivers/tablet/pen_decoder.h"
#include "drivers/transport/tcp_source.h"
#include "drivers/vrpn/vrpn_decoder.h"

namespace fude {
namespace {

using std::chrono::milliseconds;

constexpr Duration patience = std::chrono::minutes(5);  // of a test that would otherwise hang
constexpr Timestamp began{std::chrono::seconds(100)};
constexpr int frames = 40;
constexpr int poses = 500;

DeviceDescription pen() {
  DeviceDescription device;
  device.name = "Pen";
  device.kind = DeviceKind::pen_tablet;
  device.transport = "evdev";
  device.vendor = 0x056a;
  device.keys = {BTN_TOOL_PEN, BTN_TOUCH};
  device.axes = {
      {ABS_X, 0, 10000, 0, 0, 100, 50}, {ABS_Y, 0, 10000, 0, 0, 100, 0}, {ABS_PRESSURE, 0, 1023, 0, 0, 0, 0}};
  return device;
}

// Frame i at 7·i ms; the pen touches from frame 10 to frame 30.
std::vector<EvdevEvent> frame(int i) {
  std::vector<EvdevEvent> events{{EV_ABS, ABS_X, 100 + i}};
  if (i == 0) events.push_back({EV_KEY, BTN_TOOL_PEN, 1});
  if (i == 10) events.push_back({EV_KEY, BTN_TOUCH, 1});
  if (i == 30) events.push_back({EV_KEY, BTN_TOUCH, 0});
  events.push_back({EV_MSC, MSC_SERIAL, 77});
  events.push_back({EV_SYN, SYN_REPORT, 0});
  return events;
}

void add_pen(Session& session) {
  session.devices.push_back({1, pen()});
  PenDecoder decoder(pen());
  for (int i = 0; i < frames; ++i) {
    Transfer transfer;
    transfer.time = began + milliseconds(7 * i);
    transfer.payload = pack_events(frame(i));
    session.transfers.push_back({1, transfer});
    session.pens.push_back({i + 1, 1, *decoder.decode(transfer), std::nullopt});
  }
}

Pose<Tracker, Tool> pose_at(int i) {
  const double angle = 0.01 * i;
  return {Eigen::Quaterniond(std::cos(angle), std::sin(angle), 0, 0), Eigen::Vector3d(0.1, -0.2, 0.001 * i)};
}

// Pose i of each tool at 5·i ms; every tenth of the probe was not seen.
void add_tracker(Session& session) {
  DeviceDescription device;
  device.name = "Tracker";
  device.transport = "text";
  session.devices.push_back({2, device});
  for (int i = 0; i < poses; ++i)
    for (const char* tool : {"probe", "reference"}) {
      PoseSample sample;
      sample.time.host = began + milliseconds(5 * i);
      sample.tool = tool;
      sample.tracker_from_tool = pose_at(i);
      sample.valid = sample.tool != "probe" || i % 10 != 0;
      session.samples.push_back({2, sample, 1000 + i});
    }
}

struct Kernel {
  std::vector<std::vector<EvdevEvent>> frames;
  std::vector<EvdevEvent> also;
  int made = 0;
  int standing = 0;

  MakeLiveInput maker() {
    return [this](const DeviceDescription& device, std::span<const EvdevEvent> extra) -> Result<LiveInput> {
      EXPECT_EQ(device, pen());
      also.assign(extra.begin(), extra.end());
      ++made;
      ++standing;
      const std::shared_ptr<int> plugged(&standing, [](int* count) { --*count; });
      return LiveInput{"/dev/input/event9",
                       [this, plugged](std::span<const EvdevEvent> events) -> Result<void> {
                         frames.emplace_back(events.begin(), events.end());
                         return {};
                       }};
    };
  }
};

Result<LiveInput> no_uinput(const DeviceDescription&, std::span<const EvdevEvent>) {
  return failure(Fault::not_found, "there is no /dev/uinput; run `sudo modprobe uinput`");
}

PlayWish wish(double speed = 0) {
  PlayWish wish;
  wish.speed = speed;
  wish.doors = {.openigtlink = 0, .vrpn = 0};
  return wish;
}

std::unique_ptr<SessionPlayer> player(Session session, const PlayWish& wish, MakeLiveInput maker) {
  auto opened =
      SessionPlayer::open(std::move(session), wish, std::make_shared<ManualClock>(), std::move(maker));
  EXPECT_TRUE(opened) << opened.error().message;
  return std::move(*opened);
}

TEST(SessionPlayer, TheKernelIsToldEveryFrameAndTheProcessHearsEverySample) {
  Session session;
  add_pen(session);
  for (const double speed : {0.0, 1.0, 10.0}) {
    Kernel kernel;
    const auto play = player(session, wish(speed), kernel.maker());
    std::vector<PenSample> heard;
    EXPECT_TRUE(play->play([&](DeviceNumber device, const Transfer&, std::span<const Sample> samples) {
      EXPECT_EQ(device, 1);
      for (const Sample& sample : samples) heard.push_back(std::get<PenSample>(sample));
    }));
    ASSERT_EQ(kernel.frames.size(), std::size_t{frames});
    for (int i = 0; i < frames; ++i) EXPECT_EQ(kernel.frames[static_cast<std::size_t>(i)], frame(i));
    ASSERT_EQ(heard.size(), session.pens.size());
    for (std::size_t i = 0; i < heard.size(); ++i) EXPECT_EQ(heard[i], session.pens[i].sample);
    ASSERT_EQ(kernel.also.size(), 1u);
    EXPECT_EQ(kernel.also[0].type, EV_MSC);
    EXPECT_EQ(kernel.also[0].code, MSC_SERIAL);
    EXPECT_EQ(play->streams().at(0).outlet, "/dev/input/event9");
    EXPECT_EQ(play->streams().at(0).samples, std::uint64_t{frames});
    EXPECT_TRUE(play->notes().empty());
  }
}

TEST(SessionPlayer, ASoughtPlaceBeginsWithThePenDown) {
  Session session;
  add_pen(session);
  PlayWish late = wish();
  late.from = milliseconds(7 * 20);
  Kernel kernel;
  const auto play = player(session, late, kernel.maker());
  std::size_t heard = 0;
  EXPECT_TRUE(play->play([&](DeviceNumber, const Transfer&, std::span<const Sample> samples) {
    for (const Sample& sample : samples)
      EXPECT_EQ(std::get<PenSample>(sample), session.pens[20 + heard++].sample);
  }));
  EXPECT_EQ(heard, 20u);
  ASSERT_EQ(kernel.frames.size(), 21u);
  const std::vector<EvdevEvent> state{{EV_KEY, BTN_TOOL_PEN, 1},
                                      {EV_KEY, BTN_TOUCH, 1},
                                      {EV_ABS, ABS_X, 119},
                                      {EV_MSC, MSC_SERIAL, 77},
                                      {EV_SYN, SYN_REPORT, 0}};
  EXPECT_EQ(kernel.frames[0], state);
  EXPECT_EQ(kernel.frames[1], frame(20));
}

TEST(SessionPlayer, ADeviceThatWentAwayGoesAwayAndComesBack) {
  Session session;
  add_pen(session);
  session.transfers[20].transfer.kind = TransferKind::unplugged;
  session.transfers[25].transfer.kind = TransferKind::plugged;
  Kernel kernel;
  const auto play = player(session, wish(), kernel.maker());
  std::vector<int> standing;
  play->play(
      [&](DeviceNumber, const Transfer&, std::span<const Sample>) { standing.push_back(kernel.standing); });
  EXPECT_EQ(kernel.made, 2);
  for (std::size_t i = 0; i < standing.size(); ++i) EXPECT_EQ(standing[i], i > 20 && i <= 25 ? 0 : 1) << i;
}

// Reads until the server has gone.
std::vector<PoseSample> read_all(std::uint16_t port, std::function<FrameFit(Bytes)> fit, Decoder& decoder,
                                 std::atomic<bool>& connected) {
  auto source = TcpSource::open({.port = port, .fit = std::move(fit)});
  EXPECT_TRUE(source);
  for (const Transfer& greeting : decoder.greeting()) EXPECT_TRUE((*source)->write(greeting));
  connected = true;
  std::vector<PoseSample> read;
  for (;;) {
    const auto transfer = (*source)->read(monotonic_now() + patience);
    if (!transfer || !*transfer) return read;
    Decoded out;
    decoder.decode(**transfer, out);
    for (const Sample& sample : out.samples) read.push_back(std::get<PoseSample>(sample));
  }
}

void expect_poses(const std::vector<PoseSample>& read, const Session& session, double tolerance) {
  std::vector<PoseSample> sent;
  for (const RecordedSample& recorded : session.samples)
    if (const auto& sample = std::get<PoseSample>(recorded.sample); sample.valid) sent.push_back(sample);
  ASSERT_EQ(read.size(), sent.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].tool, sent[i].tool);
    EXPECT_EQ(read[i].time.device_tick, static_cast<std::uint64_t>(sent[i].time.host.time_since_epoch() /
                                                                   std::chrono::microseconds(1)));
    const Pose<Tracker, Tool>& a = read[i].tracker_from_tool;
    const Pose<Tracker, Tool>& b = sent[i].tracker_from_tool;
    EXPECT_LE((a.translation - b.translation).norm(), tolerance);
    EXPECT_LE(a.rotation.angularDistance(b.rotation), 10 * tolerance);
  }
}

TEST(SessionPlayer, ClientsReadBackThePosesOverBothProtocols) {
  Session session;
  add_tracker(session);
  auto play = player(session, wish(), no_uinput);
  ASSERT_NE(play->servers(), nullptr);
  const std::uint16_t igtl_port = play->servers()->openigtlink()->port();
  const std::uint16_t vrpn_port = play->servers()->vrpn()->port();
  std::atomic<bool> igtl_connected{false};
  std::atomic<bool> vrpn_connected{false};
  std::vector<PoseSample> over_igtl;
  std::vector<PoseSample> over_vrpn;
  OpenIgtLinkDecoder igtl;
  VrpnDecoder vrpn;
  std::thread one([&] { over_igtl = read_all(igtl_port, openigtlink::fit_message, igtl, igtl_connected); });
  std::thread two([&] { over_vrpn = read_all(vrpn_port, vrpn::fit_message, vrpn, vrpn_connected); });
  // A greeting that came when all was said would be cut off with what was not read yet.
  const auto both = [&] {
    return play->servers()->openigtlink()->clients() + play->servers()->vrpn()->clients() == 2 &&
           igtl_connected && vrpn_connected;
  };
  EXPECT_TRUE(play->stand(patience, both));
  EXPECT_TRUE(both());
  EXPECT_TRUE(play->play({}));
  EXPECT_EQ(play->streams().at(0).given, std::uint64_t{poses - poses / 10}) << "the valid ones";
  play.reset();
  one.join();
  two.join();
  expect_poses(over_igtl, session, 2e-8);  // 32-bit floats of millimetres, up to 0.5 m
  expect_poses(over_vrpn, session, 1e-15);
}

TEST(SessionPlayer, OneStreamAlone) {
  Session session;
  add_pen(session);
  add_tracker(session);
  for (const auto& [name, inputs, tools] :
       {std::tuple<const char*, int, std::size_t>{"Pen", 1, 0}, {"Tracker", 0, 2}, {"probe", 0, 1}}) {
    Kernel kernel;
    PlayWish one = wish();
    one.stream = name;
    const auto play = player(session, one, kernel.maker());
    EXPECT_EQ(kernel.made, inputs) << name;
    EXPECT_EQ(play->streams().size(), static_cast<std::size_t>(inputs) + tools) << name;
  }
  PlayWish none = wish();
  none.stream = "Mouse";
  const auto opened = SessionPlayer::open(session, none, std::make_shared<ManualClock>(), no_uinput);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().fault, Fault::not_found);
}

TEST(SessionPlayer, NothingToPlayIsSaid) {
  const auto opened = SessionPlayer::open({}, wish(), std::make_shared<ManualClock>(), no_uinput);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().fault, Fault::not_found);
  EXPECT_EQ(opened.error().message,
            "the session has nothing to play: no bytes of a device, no poses and no positions");
}

TEST(SessionPlayer, ABeginningBehindTheEndIsRefused) {
  Session session;
  add_pen(session);
  PlayWish late = wish();
  late.from = milliseconds(7 * (frames - 1));
  EXPECT_TRUE(SessionPlayer::open(session, late, std::make_shared<ManualClock>(), no_uinput));
  late.from += milliseconds(1);
  const auto opened = SessionPlayer::open(session, late, std::make_shared<ManualClock>(), no_uinput);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().fault, Fault::usage);
}

TEST(SessionPlayer, WithoutUinputTheRestGoesOnAndOneLineSaysWhatMendsIt) {
  Session session;
  add_pen(session);
  add_tracker(session);
  const auto play = player(session, wish(), no_uinput);
  ASSERT_EQ(play->notes().size(), 1u);
  EXPECT_EQ(play->notes()[0],
            "Pen is not played as a device: there is no /dev/uinput; run `sudo modprobe uinput`");
  std::size_t heard = 0;
  EXPECT_TRUE(play->play(
      [&](DeviceNumber, const Transfer&, std::span<const Sample> samples) { heard += samples.size(); }));
  EXPECT_EQ(heard, std::size_t{frames});
  EXPECT_EQ(play->streams().back().given, std::uint64_t{poses});
}

TEST(SessionPlayer, APortThatIsTakenLeavesTheOther) {
  const auto taken = TcpServer::open({});
  ASSERT_TRUE(taken);
  Session session;
  add_tracker(session);
  PlayWish at_taken = wish();
  at_taken.doors.openigtlink = (*taken)->port();
  const auto play = player(session, at_taken, no_uinput);
  EXPECT_EQ(play->servers()->openigtlink(), nullptr);
  EXPECT_NE(play->servers()->vrpn(), nullptr);
  EXPECT_EQ(play->notes().size(), 1u);
}

TEST(SessionPlayer, StopsWhileItWaits) {
  Session session;
  add_pen(session);
  session.transfers.back().transfer.time += std::chrono::hours(10'000);
  auto opened = SessionPlayer::open(session, wish(1000), std::make_shared<SystemClock>(), no_uinput);
  ASSERT_TRUE(opened);
  std::thread playing([&] { EXPECT_FALSE((*opened)->play({})); });
  (*opened)->stop();
  playing.join();
  EXPECT_LT((*opened)->streams().at(0).given, std::uint64_t{frames});
}

TEST(SessionPlayer, AMarkerIsServedAsAPlaceWithoutATurn) {
  Session session;
  DeviceDescription device;
  device.name = "Wand";
  device.transport = "text";
  session.devices.push_back({1, device});
  PositionSample seen;
  seen.time.host = began;
  seen.marker = "tip";
  seen.tracker_from_marker_m = {0.1, -0.2, 0.3};
  PositionSample lost = seen;
  lost.valid = false;
  session.samples = {{1, lost, 1}, {1, seen, 2}};
  const auto play = player(session, wish(), no_uinput);
  auto igtl =
      TcpSource::open({.port = play->servers()->openigtlink()->port(), .fit = openigtlink::fit_message});
  auto vrpn = TcpSource::open({.port = play->servers()->vrpn()->port(), .fit = vrpn::fit_message});
  ASSERT_TRUE(igtl && vrpn);
  const auto both = [&] {
    return play->servers()->openigtlink()->clients() + play->servers()->vrpn()->clients() == 2;
  };
  ASSERT_TRUE(play->stand(patience, both));
  ASSERT_TRUE(play->play({}));
  EXPECT_EQ(play->streams().at(0).given, 1u);
  const auto first = [](ByteSource& source, Decoder& decoder) {
    Decoded out;
    while (out.samples.empty()) {
      const auto transfer = source.read(monotonic_now() + patience);
      if (!transfer || !*transfer) throw std::runtime_error("nothing was served");
      decoder.decode(**transfer, out);
    }
    return out.samples.front();
  };
  OpenIgtLinkDecoder igtl_decoder;
  const auto position = std::get<PositionSample>(first(**igtl, igtl_decoder));
  EXPECT_EQ(position.marker, "tip");
  EXPECT_LT((position.tracker_from_marker_m - seen.tracker_from_marker_m).norm(), 2e-8);
  VrpnDecoder vrpn_decoder;
  for (const Transfer& greeting : vrpn_decoder.greeting()) ASSERT_TRUE((*vrpn)->write(greeting));
  const auto pose = std::get<PoseSample>(first(**vrpn, vrpn_decoder));
  EXPECT_EQ(pose.tool, "tip");
  EXPECT_EQ(pose.tracker_from_tool.translation, seen.tracker_from_marker_m);
  EXPECT_EQ(pose.tracker_from_tool.rotation.w(), 1);
}

TEST(PoseServers, NamesAreCutAndKeptApart) {
  PoseServers servers({.openigtlink = 0, .vrpn = 0});
  for (const auto& [given, served] : std::vector<std::pair<const char*, const char*>>{
           {"probe", "probe"},
           {"probe", "probe-2"},
           {"a very long name of a tool", "a very long name of "},
           {"a very long name of another", "a very long name o-2"}})
    EXPECT_EQ(servers.name(servers.add(given)), served);
}

TEST(PoseServers, AToolThatComesLateIsNamedToThoseWhoAreThere) {
  PoseServers servers({.openigtlink = 0, .vrpn = 0});
  auto source = TcpSource::open({.port = servers.vrpn()->port(), .fit = vrpn::fit_message});
  ASSERT_TRUE(source);
  VrpnDecoder decoder;
  for (const Transfer& greeting : decoder.greeting()) ASSERT_TRUE((*source)->write(greeting));
  while (servers.vrpn()->clients() < 1) servers.attend();
  PoseSample sample;
  sample.time.host = began;
  servers.send(servers.add("late"), sample);
  Decoded out;
  while (out.samples.empty()) {
    const auto transfer = (*source)->read(monotonic_now() + patience);
    ASSERT_TRUE(transfer && *transfer);
    decoder.decode(**transfer, out);
  }
  EXPECT_EQ(std::get<PoseSample>(out.samples[0]).tool, "late");
}

}  // namespace
}  // namespace fude

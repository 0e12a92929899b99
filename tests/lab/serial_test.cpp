// A serial port of a USB device on the kernel's virtual host, read and written by SerialSource.
#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/transport/serial_source.h"
#include "tests/lab/attached_node.h"
#include "tests/lab/byte_literals.h"
#include "tests/lab/reopened.h"
#include "tests/lab/replugs.h"
#include "tests/lab/scripted_port.h"
#include "tests/lab/session_recording.h"

namespace fude::lab {
namespace {

constexpr int baud = 115200;

// fude's ultrasonic receiver is known by pid.codes' second number for tests.
const UsbIdentity receiver{0x1209, 0x0002, "SOUND1", "ultrasonic receiver"};
const std::string id = "1209:0002:SOUND1";

Bytes received(const std::vector<Transfer>& transfers) {
  Bytes all;
  for (const Transfer& transfer : transfers)
    all.insert(all.end(), transfer.payload.begin(), transfer.payload.end());
  return all;
}

TEST(Serial, EveryByteGoesThroughAsItIs) {
  std::optional<ScriptedPort> port;
  const DeviceNode node = attached_node(NodeKind::serial, id, [&] { port.emplace(receiver, 0); });
  EXPECT_EQ(node.description.name, "ultrasonic receiver");
  EXPECT_EQ(node.description.transport, "serial");
  auto source = SerialSource::open(node.path, baud);
  ASSERT_TRUE(source) << source.error().message;
  const auto second = SerialSource::open(node.path, baud);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().fault, Fault::busy);

  Bytes all;
  for (unsigned value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
  SessionRecording recording(node.description);
  ASSERT_TRUE(port->send(all));
  for (std::size_t size = 0; size < all.size(); size += recording.last().payload.size())
    ASSERT_TRUE(recording.drain_one(**source));
  ASSERT_TRUE((*source)->write(to_device(TransferKind::serial, all)));
  EXPECT_EQ(port->receive(all.size()), all);
  const auto transfers = recording.finish();
  EXPECT_EQ(received(transfers), all);
  EXPECT_EQ(transfers.at(0).kind, TransferKind::serial);
  EXPECT_EQ(transfers.at(0).stamped_by, StampedBy::arrival);
}

// What the device had written but the wire had not carried when it was pulled out is truly lost: each life
// holds the beginning of what was sent in it, whole.
TEST(Serial, PulledOutAndPutBackInMidStream) {
  ScriptedPort port(receiver, 0);
  ReturningSource source =
      returning(NodeKind::serial, id, [](const auto& path) { return SerialSource::open(path, baud); });
  DeviceDescription described;
  described.id = id;
  SessionRecording recording(described);
  std::vector<Bytes> sent;
  unsigned count = 0;
  for (int life = 0; life <= replugs(); ++life) {
    if (life > 0) port.plug();
    const std::size_t begun = recording.size();
    ASSERT_EQ(recording.drain_until(source, begun + 1), begun + 1) << "life " << life;
    sent.emplace_back();
    std::thread stream([&] {
      for (Bytes frame = numbered(count, 30); port.send(frame); frame = numbered(++count, 30)) {
        sent.back().insert(sent.back().end(), frame.begin(), frame.end());
        usleep(1000);  // as devices do, some thousand a second
      }
    });
    recording.drain_until(source, begun + 5 + static_cast<std::size_t>(life % 7));
    wait_for_any_moment(life, std::chrono::milliseconds(2));
    port.unplug();
    stream.join();
    while (recording.last().kind != TransferKind::unplugged)
      ASSERT_TRUE(recording.drain_one(source))
          << "life " << life << ": " << (recording.error() ? recording.error()->message : "silence");
  }
  const auto transfers = recording.finish();
  std::size_t at = 0;
  std::size_t total = 0;
  for (const Bytes& life : sent) {
    ASSERT_EQ(transfers.at(at++).kind, TransferKind::plugged);
    Bytes arrived;
    for (; transfers.at(at).kind == TransferKind::serial; ++at)
      arrived.insert(arrived.end(), transfers[at].payload.begin(), transfers[at].payload.end());
    EXPECT_GT(arrived.size(), 30u);
    ASSERT_LE(arrived.size(), life.size() + 30);  // the frame whose sending failed may have left in part
    const std::size_t sure = std::min(arrived.size(), life.size());
    EXPECT_TRUE(
        std::equal(arrived.begin(), arrived.begin() + static_cast<std::ptrdiff_t>(sure), life.begin()));
    EXPECT_EQ(transfers.at(at++).kind, TransferKind::unplugged);
    total += arrived.size();
  }
  EXPECT_EQ(at, transfers.size());
  std::printf("figure: a USB serial port pulled out %d times in mid-stream, %zu bytes\n", replugs() + 1,
              total);
}

}  // namespace
}  // namespace fude::lab

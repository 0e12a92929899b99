// One order for all kinds of samples, and the bytes of each picture with its frame.
#include "rig/calibration/session_inputs.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace fude {
namespace {

SampleTime at(int ms) { return {.host = Timestamp(std::chrono::milliseconds(ms))}; }

RecordedPen pen(InputOrder order, int ms) {
  return {.order = order, .device = 1, .sample = {.time = at(ms)}};
}
RecordedSample imu(InputOrder order, int ms) { return {2, ImuSample{.time = at(ms)}, order}; }

std::string kinds_of(const Session& session) {
  std::string kinds;
  EXPECT_TRUE(
      for_each_input(session, [&](DeviceNumber, const Sample& sample, const Transfer*) -> Result<void> {
        kinds += std::holds_alternative<PenSample>(sample) ? 'p' : 'i';
        return {};
      }));
  return kinds;
}

TEST(SessionInputs, ComeInTheOrderOfArrivalAndWithoutOneInThatOfTheirTimes) {
  Session recorded;
  recorded.pens = {pen(1, 30), pen(4, 20)};
  recorded.samples = {imu(2, 10), imu(3, 40), imu(5, 0)};
  EXPECT_EQ(kinds_of(recorded), "piipi");
  Session made;
  made.pens = {pen(0, 10), pen(0, 30)};
  made.samples = {imu(0, 0), imu(0, 20), imu(0, 40)};
  EXPECT_EQ(kinds_of(made), "ipipi");
  EXPECT_EQ(kinds_of({}), "");
}

TEST(SessionInputs, APictureComesWithItsBytesWhereTheyAreThere) {
  Session session;
  for (const DeviceNumber camera : {1, 2})
    for (const int ms : {10, 20, 30}) {
      session.samples.push_back({camera, CameraFrame{.time = at(ms)}, 0});
      if (camera == 1 || ms != 20)
        session.transfers.push_back(
            {camera,
             {.time = at(ms).host, .kind = TransferKind::picture, .payload = {std::byte(10 * camera + ms)}}});
    }
  std::string heard;
  ASSERT_TRUE(
      for_each_input(session, [&](DeviceNumber, const Sample&, const Transfer* picture) -> Result<void> {
        heard += (picture ? std::to_string(int(picture->payload.front())) : "-") + " ";
        return {};
      }));
  EXPECT_EQ(heard, "20 30 40 30 - 50 ");
}

TEST(SessionInputs, TheFirstErrorEndsIt) {
  Session session;
  session.samples = {imu(1, 0), imu(2, 10)};
  int count = 0;
  const auto ended =
      for_each_input(session, [&](DeviceNumber, const Sample&, const Transfer*) -> Result<void> {
        ++count;
        return failure(Fault::usage, "no");
      });
  EXPECT_EQ(ended.error().message, "no");
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace fude

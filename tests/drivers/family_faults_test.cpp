// Each family's driver over a healthy stream into which a fault is put: what can be decoded is, the rest is
// counted, and the stream goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "tests/fakes/family_streams.h"
#include "tests/fakes/sound_sample.h"
#include "tests/fakes/transfers.h"

namespace fude {
namespace {

constexpr unsigned count = 40;

SampleTime& time_of(Sample& sample) {
  return std::visit([](auto& s) -> SampleTime& { return s.time; }, sample);
}

bool after_gap(const Sample& sample) {
  return std::visit([](const auto& s) { return s.after_gap; }, sample);
}

// What was measured and when; a pose has no equality of its own.
bool same(const Sample& a, const Sample& b) {
  return a.index() == b.index() &&
         std::visit(
             [&b]<class T>(const T& x) {
               const T& y = std::get<T>(b);
               if constexpr (requires { x == y; })
                 return x == y;
               else if constexpr (requires { x.tracker_from_tool; })
                 return x.time == y.time && x.after_gap == y.after_gap &&
                        x.tracker_from_tool.translation == y.tracker_from_tool.translation &&
                        x.tracker_from_tool.rotation.coeffs() == y.tracker_from_tool.rotation.coeffs();
               else
                 return false;
             },
             a);
}

// Decodes on, checking what must hold of every sample.
std::vector<Sample> decoded_all(Decoder& decoder, const std::vector<Transfer>& transfers) {
  std::vector<Sample> all;
  for (const Transfer& transfer : transfers)
    for (Sample& sample : decoded(decoder, transfer).samples) {
      EXPECT_TRUE(is_sound(sample));
      if (!all.empty()) {
        EXPECT_GE(time_of(sample).sequence, time_of(all.back()).sequence);
      }
      all.push_back(std::move(sample));
    }
  return all;
}

class FamilyFaults : public testing::TestWithParam<int> {
 protected:
  FamilyFaults() : stream_(family_streams(count).at(static_cast<std::size_t>(GetParam()))) {}

  std::unique_ptr<Decoder> greeted() {
    auto decoder = stream_.decoder();
    decoder->greeting();
    for (const Transfer& answer : stream_.introduction) decoded(*decoder, answer);
    return decoder;
  }

  std::size_t all_samples() const { return stream_.samples * count; }

  FamilyStream stream_;
};

TEST_P(FamilyFaults, WithoutAnyEachReportIsASample) {
  const auto decoder = greeted();
  const auto samples = decoded_all(*decoder, stream_.reports);
  ASSERT_EQ(samples.size(), all_samples());
  for (const Sample& sample : samples) EXPECT_FALSE(after_gap(sample));
  EXPECT_EQ(decoder->counts().lost, 0u);
  EXPECT_EQ(decoder->counts().malformed, 0u);
}

// A stream of bytes may be read in any pieces: the very same samples.
TEST_P(FamilyFaults, ShortReads) {
  if (!stream_.in_bytes) return;  // its reports come whole
  const auto whole = decoded_all(*greeted(), stream_.reports);
  for (const std::size_t size : {1u, 2u, 3u, 7u, 31u}) {
    std::vector<Transfer> pieces;
    for (const Transfer& report : stream_.reports)
      for (std::size_t at = 0; at < report.payload.size(); at += size) {
        pieces.push_back(report);
        auto& payload = pieces.back().payload;
        payload.erase(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(at));
        payload.resize(std::min(size, payload.size()));
      }
    const auto samples = decoded_all(*greeted(), pieces);
    ASSERT_EQ(samples.size(), whole.size()) << size;
    for (std::size_t i = 0; i < whole.size(); ++i)
      EXPECT_TRUE(same(samples[i], whole[i])) << size << ' ' << i;
  }
}

// One report is cut short, at every byte: at most its neighbour goes with it. (Half a report of a newer
// SpaceMouse is a whole one of an older.)
TEST_P(FamilyFaults, AReportCutShort) {
  const std::size_t size = stream_.reports.at(count / 2).payload.size();
  for (std::size_t kept = 0; kept < size; ++kept) {
    auto reports = stream_.reports;
    reports[count / 2].payload.resize(kept);
    const auto decoder = greeted();
    const auto samples = decoded_all(*decoder, reports);
    EXPECT_GE(samples.size(), all_samples() - 2 * stream_.samples) << kept;
    EXPECT_LE(samples.size(), all_samples()) << kept;
  }
}

TEST_P(FamilyFaults, GarbageInTheMiddle) {
  if (stream_.from_kernel) return;
  auto reports = stream_.reports;
  auto& payload = reports[count / 2].payload;
  for (std::size_t i = 0; i < payload.size(); ++i)
    if (i != 2) payload[i] = static_cast<std::byte>(151 * i + 0xfd);  // a Falcon's message begins there
  const auto decoder = greeted();
  const auto samples = decoded_all(*decoder, reports);
  EXPECT_GE(samples.size(), all_samples() - 2 * stream_.samples);
  EXPECT_LT(samples.size(), all_samples());
  EXPECT_GE(decoder->counts().malformed + decoder->counts().lost + decoder->counts().unknown, 1u);
}

// The wire is cut after every byte there is; the device comes back and begins anew.
TEST_P(FamilyFaults, UnpluggedAtEveryByte) {
  const auto fresh = decoded_all(*greeted(), stream_.reports);
  const auto& first = stream_.reports[0];
  const auto& second = stream_.reports[1];
  for (std::size_t cut = 0; cut <= second.payload.size(); ++cut) {
    auto decoder = greeted();
    auto part = second;
    part.payload.resize(cut);
    const auto before = decoded_all(*decoder, {first, part});
    EXPECT_GE(before.size(), stream_.samples * (cut == second.payload.size() ? 2 : 1)) << cut;
    decoded(*decoder, from_device(TransferKind::unplugged));
    decoded(*decoder, from_device(TransferKind::plugged));
    decoder->greeting();
    for (const Transfer& answer : stream_.introduction) decoded(*decoder, answer);
    const auto after = decoded_all(*decoder, stream_.reports);
    ASSERT_EQ(after.size(), fresh.size()) << cut;
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after_gap(after[i]), i == 0) << cut << ' ' << i;
  }
}

// The machine sleeps after any report, the device stays where it is: the next sample follows a gap, nothing
// counts as lost or malformed, and the stream goes on.
TEST_P(FamilyFaults, SuspendedInMidStream) {
  for (std::size_t before = 0; before < 6; ++before) {
    const auto decoder = greeted();
    decoded_all(*decoder,
                {stream_.reports.begin(), stream_.reports.begin() + static_cast<std::ptrdiff_t>(before)});
    decoded(*decoder, from_device(TransferKind::suspended));
    decoded(*decoder, from_device(TransferKind::plugged));
    decoder->greeting();
    for (const Transfer& answer : stream_.introduction) decoded(*decoder, answer);
    const auto after = decoded_all(*decoder, stream_.reports);
    ASSERT_EQ(after.size(), all_samples()) << before;
    for (std::size_t i = 0; i < after.size(); ++i)
      EXPECT_EQ(after_gap(after[i]), i == 0) << before << ' ' << i;
    EXPECT_EQ(decoder->counts().malformed, 0u);
    EXPECT_EQ(decoder->counts().lost, 0u);
  }
}

TEST_P(FamilyFaults, NeighboursChangePlaces) {
  auto reports = stream_.reports;
  for (std::size_t i = 10; i + 1 < reports.size(); i += 7) std::swap(reports[i], reports[i + 1]);
  const auto samples = decoded_all(*greeted(), reports);
  EXPECT_GT(samples.size(), count / 2);
}

TEST_P(FamilyFaults, TimeRunsBackwards) {
  auto reports = stream_.reports;
  for (std::size_t i = count / 2; i < count; ++i) reports[i].time -= std::chrono::seconds(3);
  EXPECT_EQ(decoded_all(*greeted(), reports).size(), all_samples());
}

TEST_P(FamilyFaults, ALongSilence) {
  auto reports = stream_.reports;
  for (std::size_t i = count / 2; i < count; ++i) reports[i].time += std::chrono::minutes(3);
  EXPECT_EQ(decoded_all(*greeted(), reports).size(), all_samples());
}

std::string family_name(const testing::TestParamInfo<int>& info) {
  std::string name = family_streams(1).at(static_cast<std::size_t>(info.param)).name;
  std::erase_if(name, [](char c) { return c == ' ' || c == '-' || c == ','; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, FamilyFaults, testing::Range(0, static_cast<int>(family_streams(1).size())),
                         family_name);

}  // namespace
}  // namespace fude

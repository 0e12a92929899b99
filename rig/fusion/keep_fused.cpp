#include "rig/fusion/keep_fused.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "capture/copy_session.h"

namespace fude {
namespace {

Result<void> add_stream(SessionWriter& to, DeviceNumber device, const FusedSession& fused, const char* tool) {
  std::uint64_t sequence = 0;
  for (const FusedRow& row : fused.rows)
    if (const auto added = to.add_sample(device, sample_of(row, tool, sequence++)); !added)
      return tl::unexpected(added.error());
  return {};
}

Session without_fusion(Session session) {
  const auto earlier =
      std::find_if(session.devices.begin(), session.devices.end(),
                   [](const RecordedDevice& device) { return device.description.id == fused_device_id; });
  if (earlier == session.devices.end()) return session;
  std::erase_if(session.samples,
                [number = earlier->number](const RecordedSample& s) { return s.device == number; });
  session.devices.erase(earlier);
  return session;
}

Result<void> write(const Session& session, const FusedArchive& fused, const std::filesystem::path& file) {
  auto to = SessionWriter::create(file);
  if (!to) return tl::unexpected(to.error());
  if (auto copied = copy_session(session, *to); !copied) return copied;
  DeviceDescription device{.id = std::string(fused_device_id), .name = "fusion", .kind = DeviceKind::tracker};
  device.transport = "fusion";
  const auto number = to->add_device(device);
  if (!number) return tl::unexpected(number.error());
  if (auto added = add_stream(*to, *number, fused.causal, "fused"); !added) return added;
  if (auto added = add_stream(*to, *number, fused.smoothed, "smoothed"); !added) return added;
  // A session that was not closed in good order stays one.
  return session.complete ? to->close() : to->flush();
}

}  // namespace

Result<void> keep_fused(Session session, const FusedArchive& fused, const std::filesystem::path& file,
                        bool overwrite) {
  std::error_code wrong;
  if (!overwrite && std::filesystem::exists(file, wrong))
    return failure(Fault::exists, file.string() + " exists already; choose another name or give --force");
  const std::filesystem::path unfinished = file.string() + ".part";
  const auto remove = [&] {
    for (const char* ending : {"", "-wal", "-journal", "-shm"})
      std::filesystem::remove(unfinished.string() + ending, wrong);
  };
  remove();
  if (auto written = write(without_fusion(std::move(session)), fused, unfinished); !written) {
    remove();
    return written;
  }
  std::filesystem::rename(unfinished, file, wrong);
  if (wrong) return failure(Fault::storage, file.string() + " cannot be written: " + wrong.message());
  return {};
}

}  // namespace fude

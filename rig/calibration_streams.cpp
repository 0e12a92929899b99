#include "rig/calibration_streams.h"

#include <optional>

#include "capture/streams.h"
#include "signal/pose_history.h"

namespace fude {
namespace {

bool holds_poses(const SessionStream& stream) {
  return std::holds_alternative<PoseSample>(sample_tables()[stream.kind].blank);
}

Result<SessionStream> only_tool(const Session& session, const std::string& reference) {
  std::optional<SessionStream> only;
  std::string names;
  for (const SessionStream& stream : streams_of(session)) {
    if (!holds_poses(stream) || stream.part == reference || stream.name == reference) continue;
    names += (names.empty() ? "" : ", ") + (stream.part.empty() ? stream.name : stream.part);
    if (only) only->name.clear();
    if (!only) only = stream;
  }
  if (!only) return failure(Fault::not_found, "the session holds no poses of a tool");
  if (only->name.empty())
    return failure(Fault::not_found, "the session has several tools: name one with --tool (" + names + ")");
  return *only;
}

Result<std::vector<PoseSample>> poses_of(const Session& session, const Result<SessionStream>& stream) {
  if (!stream) return tl::unexpected(stream.error());
  if (!holds_poses(*stream))
    return failure(Fault::not_found, stream->name + " holds no poses; name a tool of a tracker");
  std::vector<PoseSample> poses;
  for (std::size_t i = 0; i < stream->samples.size(); ++i)
    poses.push_back(std::get<PoseSample>(sample_at(session, *stream, i)));
  return poses;
}

}  // namespace

Result<std::vector<PoseSample>> tool_poses(const Session& session, const std::string& tool,
                                           const std::string& reference) {
  auto poses = poses_of(session, tool.empty() ? only_tool(session, reference) : find_stream(session, tool));
  if (!poses || reference.empty()) return poses;
  const auto seen_from = poses_of(session, find_stream(session, reference));
  if (!seen_from) return tl::unexpected(seen_from.error());
  PoseHistory history({.samples = seen_from->size() + 1});
  for (const PoseSample& sample : *seen_from) history.add(sample);
  for (PoseSample& sample : *poses) {
    const PoseAnswer from = history.at(sample.time.host);
    sample.covariance.reset();
    if (from.origin == PoseOrigin::none) {
      sample.valid = false;
      continue;
    }
    const auto reference_from_tracker = from.tracker_from_tool.inverse();
    sample.tracker_from_tool = {reference_from_tracker.rotation * sample.tracker_from_tool.rotation,
                                reference_from_tracker * sample.tracker_from_tool.translation};
  }
  return poses;
}

Result<std::vector<ImuSample>> imu_samples(const Session& session, const std::string& unit) {
  const auto stream = find_stream(session, unit.empty() ? "imu" : unit);
  if (!stream) return tl::unexpected(stream.error());
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < stream->samples.size(); ++i)
    if (const Sample sample = sample_at(session, *stream, i);
        const auto* imu = std::get_if<ImuSample>(&sample))
      samples.push_back(*imu);
  if (samples.empty())
    return failure(Fault::not_found,
                   stream->name + " holds no readings of an inertial unit; name one with --tool");
  return samples;
}

}  // namespace fude

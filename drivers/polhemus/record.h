// The binary records of Polhemus's trackers as they stand on the wire (firmware-notes/polhemus.md).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/byte_order.h"
#include "drivers/frame_stream.h"

namespace fude::polhemus {

enum class Dialect : std::uint8_t { fastrak, liberty };  // PATRIOT and LIBERTY LATUS speak as LIBERTY does

// What was asked for: the output list, and the unit of positions.
struct Layout {
  Dialect dialect = Dialect::liberty;
  std::vector<unsigned> items;
  bool centimetres = true;  // else inches
};

// What fude asks for: position and quaternion, with time, frame, stylus and distortion where there are any.
Layout usual_layout(Dialect dialect);

// Of the list, without what stands before it; none where an item is not in items.inl.
std::optional<std::size_t> body_length(const Layout& layout);

inline constexpr std::size_t longest_record = 8 + 256;

// A record of measurement, or (LIBERTY) an answer of another kind, which is told by its length alone. What
// looks like the beginning of one and cannot be one is damaged: a position that is not finite or beyond
// 100 m, a quaternion that is far from unit length, though no error is flagged.
FrameFit fit_record(Bytes bytes, const Layout& layout);

struct Record {
  unsigned station = 0;  // 1 is the first
  bool flagged = false;  // the tracker reports an error with this measurement
  std::optional<Eigen::Vector3d> position_m;
  std::optional<Eigen::Quaterniond> rotation;  // source from sensor, unit length
  std::optional<std::uint32_t> time_ms;
  std::optional<std::uint32_t> frame;
  std::optional<std::uint32_t> stylus;
  std::optional<std::int32_t> distortion;
};

// Of a whole frame; none where it is no measurement in this layout.
std::optional<Record> read_record(Bytes frame, const Layout& layout);

}  // namespace fude::polhemus

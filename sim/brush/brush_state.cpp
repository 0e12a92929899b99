// The bytes of a brush state. One walk over its fields serves writing and reading.
#include <bit>
#include <cmath>
#include <type_traits>

#include "sim/brush/brush.h"

namespace fude {
namespace {

constexpr std::uint64_t signature = 0x3330687375726266ULL;  // "fbrush03"

class Writer {
 public:
  void operator()(const double& value) { put(std::bit_cast<std::uint64_t>(value)); }
  void operator()(const bool& value) { bytes.push_back(std::byte{value}); }
  void operator()(const std::int64_t& value) { put(static_cast<std::uint64_t>(value)); }
  template <class M>
  void dynamic(const M& matrix) {
    put(static_cast<std::uint64_t>(matrix.rows()));
    put(static_cast<std::uint64_t>(matrix.cols()));
    for (Eigen::Index i = 0; i < matrix.size(); ++i) (*this)(matrix.data()[i]);
  }
  void sequence(const auto& items, std::size_t) { put(items.size()); }
  bool sound = true;
  std::vector<std::byte> bytes;

 private:
  void put(std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8)
      bytes.push_back(static_cast<std::byte>((word >> shift) & 0xff));
  }
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : left(bytes) {}
  void operator()(double& value) {
    value = std::bit_cast<double>(word());
    if (!std::isfinite(value)) sound = false;
  }
  void operator()(bool& value) {
    if (left.empty() || left[0] > std::byte{1}) {
      sound = false;
      return;
    }
    value = left[0] == std::byte{1};
    left = left.subspan(1);
  }
  void operator()(std::int64_t& value) { value = static_cast<std::int64_t>(word()); }
  template <class M>
  void dynamic(M& matrix) {
    const std::uint64_t rows = word();
    const std::uint64_t columns = word();
    if (!sound || rows > static_cast<std::uint64_t>(M::MaxRowsAtCompileTime) ||
        columns > static_cast<std::uint64_t>(M::MaxColsAtCompileTime)) {
      sound = false;
      return;
    }
    matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    for (Eigen::Index i = 0; i < matrix.size(); ++i) (*this)(matrix.data()[i]);
  }
  // `bytes_each`: at least so many are written of an item.
  void sequence(auto& items, std::size_t bytes_each) {
    const std::uint64_t count = word();
    if (count > left.size() / bytes_each) {  // memory in proportion to the bytes there are
      sound = false;
      return;
    }
    items.resize(count);
  }
  bool sound = true;
  std::span<const std::byte> left;

 private:
  std::uint64_t word() {
    if (left.size() < 8) {
      sound = false;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8; ++i) value |= std::to_integer<std::uint64_t>(left[i]) << (8 * i);
    left = left.subspan(8);
    return value;
  }
};

template <class Archive, class Vector>
void vector(Archive& archive, Vector& v) {
  for (Eigen::Index i = 0; i < v.size(); ++i) archive(v[i]);
}

template <class Archive, class P>
void pose(Archive& archive, P& p) {
  vector(archive, p.rotation.coeffs());
  vector(archive, p.translation);
}

template <class Archive, class Root>
void tuft_root(Archive& archive, Root& root) {
  archive(root.parent);
  archive(root.node);
  vector(archive, root.at);
  vector(archive, root.lean_rad);
  archive(root.width);
  archive(root.hair);
}

template <class Archive, class State>
void tuft_state(Archive& archive, State& tuft) {
  archive.dynamic(tuft.x);
  archive.dynamic(tuft.hessian);
  archive(tuft.hessian_step_s);
  for (auto& set : tuft.set_rad) vector(archive, set);
  archive.dynamic(tuft.reactions);
  for (auto& p : tuft.submerged) archive(p);
  for (auto& c : tuft.minor_mm) archive(c);
  for (auto& sides : tuft.touches)
    for (auto& touch : sides) {
      archive(touch.touching);
      vector(archive, touch.anchor);
    }
  archive(tuft.plane.stands);
  vector(archive, tuft.plane.stuck);
  vector(archive, tuft.plane.facing);
  archive(tuft.plane.lead_mm);
  archive(tuft.in_contact);
  pose(archive, tuft.paper_from_handle);
  archive(tuft.placed);
}

// Every field, in the order of the structs.
template <class Archive, class State>
void walk(Archive& archive, State& state) {
  archive.sequence(state.tufts, 512);
  for (auto& tuft : state.tufts) {
    tuft_root(archive, tuft.root);
    tuft_state(archive, tuft.state);
  }
  pose(archive, state.paper_from_handle);
  const auto part = [&](auto& hair) {
    archive(hair.capacity_ul);
    archive(hair.water_ul);
    for (auto& volume : hair.pigment_ul) archive(volume);
  };
  for (auto& patch : state.loading.patches) part(patch);
  for (auto& row : state.loading.inside) part(row);
  archive(state.loading.unspread_s);
  archive(state.loading.endless);
  archive.sequence(state.loading.set_aside, sizeof(Withdrawal));
  for (auto& withdrawal : state.loading.set_aside)
    for (auto& patch : withdrawal) {
      archive(patch.water_ul);
      for (auto& volume : patch.pigment_ul) archive(volume);
    }
  archive(state.footprint.taken);
  archive(state.footprint.soak_mm);
  archive.sequence(state.footprint.wetness, sizeof(double));
  for (auto& wet : state.footprint.wetness) archive(wet);
  archive(state.timed);
}

}  // namespace

std::vector<std::byte> bytes_of(const BrushState& state) {
  Writer writer;
  writer(static_cast<std::int64_t>(signature));
  walk(writer, state);
  writer(std::int64_t{state.last.time_since_epoch().count()});
  return std::move(writer.bytes);
}

namespace {

// Each tuft hangs from the handle, or from a node between the ends of one before it that hangs there.
bool hangs_together(const BrushState& state) {
  if (state.tufts.empty() || state.tufts.size() > most_tufts) return false;
  const std::size_t row = state.footprint.wetness.size();
  if (row != 0 && row != state.tufts.size()) return false;
  for (std::size_t i = 0; i < state.tufts.size(); ++i) {
    const TuftRoot& root = state.tufts[i].root;
    if (root.parent == -1) continue;
    if (root.parent < 0 || root.parent >= static_cast<std::int64_t>(i)) return false;
    if (state.tufts[static_cast<std::size_t>(root.parent)].root.parent != -1) return false;
    if (root.node < 1 || root.node >= max_segments) return false;
  }
  return true;
}

}  // namespace

Result<BrushState> brush_state_of(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  std::int64_t found = 0;
  reader(found);
  BrushState state;
  walk(reader, state);
  std::int64_t last = 0;
  reader(last);
  state.last = Timestamp(Duration(last));
  if (!reader.sound || !reader.left.empty() || !hangs_together(state) ||
      found != static_cast<std::int64_t>(signature))
    return failure(Fault::malformed, "these bytes are no brush state of this version");
  return state;
}

}  // namespace fude

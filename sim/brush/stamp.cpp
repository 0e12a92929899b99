#include "sim/brush/stamp.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "sim/brush/loading.h"

namespace fude {

using Eigen::Vector2d;

namespace {

constexpr int blocks_per_word = 64;
constexpr std::size_t tip_patches = 2 * patches_around;  // the last quarter of the tuft

bool any(const auto& words) {
  return std::any_of(words.begin(), words.end(), [](auto bits) { return bits != 0; });
}

// Bits [first, end) of word `word` of a row of bits.
std::uint64_t mask(int first, int end, int word) {
  const int from = std::max(first - 64 * word, 0);
  const int to = std::min(end - 64 * word, 64);
  if (from >= to) return 0;
  return ~std::uint64_t{0} << from & ~std::uint64_t{0} >> (64 - to);
}

}  // namespace

Stamp::Stamp(const CoverageFrame& frame, const HairLook& look, double widest, FootprintMap& map)
    : frame_(frame), look_(look), map_(map) {
  map.patch.assign(map.fresh.size(), 0);
  for (const TuftHair& tuft : look.tufts) {
    float driest = 1;
    float tip = 0;
    for (std::size_t i = 0; i < tuft.patches.size(); ++i) {
      const float wetness = look.loads[tuft.patches[i]].wetness;
      driest = std::min(driest, wetness);
      if (i + tip_patches >= tuft.patches.size()) tip += wetness / tip_patches;
    }
    streaky_ = streaky_ || tuft.texture->reach(driest, 0) < 1 || tuft.texture->opening(driest, widest) > 0;
    split_shift_.push_back(tuft.texture->split_shift(tip));
  }
  if (streaky_) {
    inked_.assign(map.fresh.size(), 1);
    reach_.assign(map.fresh.size(), 1);
  }
  block_columns_ = frame.columns() / block_side;
  block_rows_ = (frame.rows + block_side - 1) / block_side;
  block_words_ = static_cast<std::size_t>((block_columns_ + blocks_per_word - 1) / blocks_per_word);
  waiting_.assign(block_words_ * static_cast<std::size_t>(block_rows_), 0);
  named_ = waiting_;
}

void Stamp::wait_for(const Coverage& cover) {
  constexpr int blocks_in_word = cells_per_word / block_side;
  for (int block_row = 0; block_row < block_rows_; ++block_row)
    for (int word = 0; word < frame_.words; ++word) {
      std::uint64_t bits = 0;
      for (int row = block_row * block_side; row < std::min((block_row + 1) * block_side, frame_.rows); ++row)
        bits |= cover.columns(row, word);
      if (bits == 0) continue;
      // A bit for each sixteen columns of samples, drawn together.
      bits |= bits >> 8;
      bits |= bits >> 4;
      bits |= bits >> 2;
      bits |= bits >> 1;
      bits = (bits & 1) | (bits >> 15 & 2) | (bits >> 30 & 4) | (bits >> 45 & 8);
      const int column = word * blocks_in_word;
      const std::size_t i = static_cast<std::size_t>(block_row) * block_words_ +
                            static_cast<std::size_t>(column / blocks_per_word);
      waiting_[i] |= bits << (column % blocks_per_word) & ~named_[i];
    }
}

bool Stamp::waits() const { return any(waiting_); }
bool Stamp::rim_waits() const { return any(rim_); }

// Patches hold one wetness each; between their middles it goes over.
float Stamp::wetness_at(double along, double around) const {
  const double row = std::clamp(along * patches_along - 0.5, 0.0, patches_along - 1.0);
  const double column = (around + 1) * patches_around + (patches_around - 0.5);
  const int i = std::min(static_cast<int>(row), patches_along - 2);
  const int j = static_cast<int>(column);
  const auto up = static_cast<float>(row - i);
  const auto on = static_cast<float>(column - j);
  const auto wet = [&](int y, int x) {
    return look_.loads[now_.patches[static_cast<std::size_t>(y * patches_around + x % patches_around)]]
        .wetness;
  };
  const float low = wet(i, j) + on * (wet(i, j + 1) - wet(i, j));
  const float high = wet(i + 1, j) + on * (wet(i + 1, j + 1) - wet(i + 1, j));
  return low + up * (high - low);
}

HairCorner Stamp::corner_at(const Vector2d& at, double along, double around, const HairState& state) const {
  HairCorner corner{static_cast<float>((at.x() - frame_.left_mm()) / frame_.cell_mm),
                    static_cast<float>((at.y() - frame_.bottom_mm()) / frame_.cell_mm),
                    Hair(static_cast<float>(along), static_cast<float>(around + 1), 1, 0)};
  if (streaky_) {
    const float wetness = wetness_at(along, around);
    corner.hair[2] = now_.texture->reach(wetness, state.press_mn_mm);
    corner.hair[3] = now_.texture->opening(wetness, state.spread);
  }
  return corner;
}

void Stamp::take_up(std::size_t tuft) {
  now_ = look_.tufts[tuft];
  now_shift_ = split_shift_[tuft];
}

std::uint16_t Stamp::patch_of(const Hair& hair) const {
  // At the rim of a block the straight way may lead beyond the tuft.
  const double around = std::max(static_cast<double>(hair[1]) - 1, -1.0);
  const int own = patch_at(static_cast<double>(hair[0]), around);
  return now_.patches[static_cast<std::size_t>(own)];
}

void Stamp::add(std::size_t tuft, const Contact& contact) {
  take_up(tuft);
  using Ring = std::array<HairCorner, ring_points>;
  const auto corners = [&](const ContactRing& ring) {
    Ring all;
    for (std::size_t j = 0; j < ring_points; ++j)
      all[j] = corner_at(ring.point[j], ring.along, ring.around[j], ring.hair);
    return all;
  };
  for (std::size_t r = 0; r < contact.run_ends.size(); ++r) {
    const auto run = contact.run(r);
    Ring before = corners(run.front());
    for (std::size_t i = 1; i < run.size(); ++i) {
      const Ring here = corners(run[i]);
      for (std::size_t j = 1; j < ring_points; ++j)
        name_blocks({before[j - 1], before[j], here[j], here[j - 1]});
      before = here;
    }
  }
}

bool Stamp::waits_under(const HairQuad& quad) const {
  float left = quad[0].x;
  float right = left;
  float bottom = quad[0].y;
  float top = bottom;
  for (const HairCorner& corner : quad) {
    left = std::min(left, corner.x);
    right = std::max(right, corner.x);
    bottom = std::min(bottom, corner.y);
    top = std::max(top, corner.y);
  }
  const auto first_word = static_cast<std::size_t>(first_centre(left, block_columns_)) / blocks_per_word;
  const auto end_word = std::min(
      static_cast<std::size_t>(first_centre(right, block_columns_)) / blocks_per_word + 1, block_words_);
  const auto end_row = static_cast<std::size_t>(first_centre(top, block_rows_));
  std::uint64_t waits = 0;
  for (auto row = static_cast<std::size_t>(first_centre(bottom, block_rows_)); row < end_row; ++row)
    for (std::size_t word = first_word; word < end_word; ++word) waits |= waiting_[row * block_words_ + word];
  return waits != 0;
}

void Stamp::name_blocks(HairQuad quad) {
  for (HairCorner& corner : quad) {
    corner.x /= block_side;
    corner.y /= block_side;
  }
  if (!waits_under(quad)) return;
  const auto [first_row, end_row] = find_rows(quad, block_rows_, rows_);
  HairSlope slope;
  if (streaky_) slope = slope_of(quad);
  for (int row = first_row; row < end_row; ++row) {
    const HairRow& ends = rows_[static_cast<std::size_t>(row - first_row)];
    // Half a block more on either side, to the rim.
    const int first = first_centre(ends.from - 0.5F, block_columns_);
    const int end = first_centre(ends.to + 0.5F, block_columns_);
    for (int word = first / blocks_per_word; word * blocks_per_word < end; ++word) {
      const std::size_t i = static_cast<std::size_t>(row) * block_words_ + static_cast<std::size_t>(word);
      std::uint64_t bits = waiting_[i] & mask(first, end, word);
      if (bits == 0) continue;
      waiting_[i] &= ~bits;
      named_[i] |= bits;
      const float by_column = 1 / std::max(ends.to - ends.from, 1e-6F);
      for (; bits != 0; bits &= bits - 1) {
        const int column = word * blocks_per_word + std::countr_zero(bits);
        const float share =
            std::clamp((static_cast<float>(column) + 0.5F - ends.from) * by_column, 0.0F, 1.0F);
        write_block(row, column, ends.first + share * (ends.last - ends.first), slope);
      }
    }
  }
}

Hair Stamp::hair_near(std::span<const ContactMesh> contacts, int row, int column) {
  const Vector2d centre(frame_.left_mm() + (column + 0.5) * block_side * frame_.cell_mm,
                        frame_.bottom_mm() + (row + 0.5) * block_side * frame_.cell_mm);
  Hair nearest(1, 1, 0, 0);
  double least = std::numeric_limits<double>::max();
  take_up(0);
  for (std::size_t tuft = 0; tuft < contacts.size(); ++tuft)
    for (const ContactRing& ring : contacts[tuft].contact().rings)
      for (std::size_t j = 0; j < ring_points; ++j) {
        const double distance = (ring.point[j] - centre).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        take_up(tuft);
        nearest = corner_at(ring.point[j], ring.along, ring.around[j], ring.hair).hair;
      }
  return nearest;
}

void Stamp::name_rest(std::span<const ContactMesh> contacts) {
  for (int row = 0; row < block_rows_; ++row)
    for (std::size_t word = 0; word < block_words_; ++word)
      for (std::uint64_t bits = waiting_[static_cast<std::size_t>(row) * block_words_ + word]; bits != 0;
           bits &= bits - 1) {
        const int column = static_cast<int>(word) * blocks_per_word + std::countr_zero(bits);
        const Hair hair = hair_near(contacts, row, column);
        write_block(row, column, hair, {Hair::Zero(), Hair::Zero(), hair, hair});
      }
}

void Stamp::write_block(int row, int column, const Hair& centre, const HairSlope& by_block) {
  const int end_row = std::min((row + 1) * block_side, frame_.rows);
  if (!streaky_) {
    const std::uint16_t patch = patch_of(centre);
    for (int y = row * block_side; y < end_row; ++y)
      std::fill_n(map_.patch.data() + y * map_.columns + column * block_side, block_side, patch);
    return;
  }
  constexpr float share = 1.0F / block_side;
  const Hair by_x = share * by_block.by_x;
  const Hair by_y = share * by_block.by_y;
  Hair start = centre + 0.5F * (1 - block_side) * (by_x + by_y);
  for (int y = row * block_side; y < end_row; ++y, start += by_y) {
    Hair hair = start;
    for (int x = column * block_side; x < (column + 1) * block_side; ++x, hair += by_x)
      write_cell(static_cast<std::size_t>(y * map_.columns + x), hair.max(by_block.low).min(by_block.high));
  }
}

void Stamp::write_cell(std::size_t cell, const Hair& hair) {
  map_.patch[cell] = patch_of(hair);
  inked_[cell] = now_.texture->inked(hair[0], hair[1], hair[2], hair[3], now_shift_);
  reach_[cell] = hair[2];
}

void Stamp::wait_for_rim(const Coverage& cover) {
  rim_.clear();
  for (int row = 0; row < frame_.rows; ++row)
    for (int word = 0; word < frame_.words; ++word)
      rim_.push_back(static_cast<std::uint16_t>(cover.any(row, word) ? cover.cells(row, word) : 0));
}

void Stamp::add_passage(std::size_t tuft, const ContactMesh& from, const ContactMesh& to) {
  take_up(tuft);
  const auto corner = [&](const MeshPoint& p) {
    return corner_at(p.at, p.on_tuft.x(), p.on_tuft.y(), p.hair);
  };
  for_each_passage(from, to,
                   [&](const MeshPoint& a, const MeshPoint& b, const MeshPoint& c, const MeshPoint& d) {
                     write_cells({corner(a), corner(b), corner(c), corner(d)});
                   });
}

void Stamp::write_cells(const HairQuad& quad) {
  const auto [first_row, end_row] = find_rows(quad, frame_.rows, rows_);
  for (int row = first_row; row < end_row; ++row) {
    const HairRow& ends = rows_[static_cast<std::size_t>(row - first_row)];
    const int first = first_centre(ends.from, map_.columns);
    const int end = first_centre(ends.to, map_.columns);
    if (first >= end) continue;
    const Hair by_column = (ends.last - ends.first) / std::max(ends.to - ends.from, 1e-6F);
    Hair hair = ends.first + (static_cast<float>(first) + 0.5F - ends.from) * by_column;
    for (int column = first; column < end; ++column, hair += by_column) {
      std::uint16_t& waits = rim_[static_cast<std::size_t>(row * frame_.words + column / cells_per_word)];
      const auto bit = static_cast<std::uint16_t>(1U << column % cells_per_word);
      if ((waits & bit) == 0) continue;
      waits = static_cast<std::uint16_t>(waits & ~bit);
      write_cell(static_cast<std::size_t>(row * map_.columns + column), hair);
    }
  }
}

void Stamp::take_off_hollows() {
  const HairTexture& hair = *look_.tufts[0].texture;  // all tufts of a brush meet the paper alike
  std::vector<float> heights;
  for (int row = 0; row < frame_.rows; ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(map_.columns);
    const auto needed = [&](int column) {
      const std::size_t i = begin + static_cast<std::size_t>(column);
      return reach_[i] < 1 && map_.contact_s[i] + map_.fresh[i] > 0;
    };
    int first = 0;
    int end = map_.columns;
    while (first < end && !needed(first)) ++first;
    while (end > first && !needed(end - 1)) --end;
    if (first == end) continue;
    heights.resize(static_cast<std::size_t>(end - first));
    look_.grain->heights(frame_.left_mm() + (first + 0.5) * frame_.cell_mm,
                         frame_.bottom_mm() + (row + 0.5) * frame_.cell_mm, frame_.cell_mm, heights);
    for (std::size_t k = 0; k < heights.size(); ++k) {
      const std::size_t i = begin + static_cast<std::size_t>(first) + k;
      inked_[i] *= HairTexture::grained(hair.hills(reach_[i]), heights[k]);
    }
  }
}

void Stamp::finish() {
  if (look_.grain && look_.tufts[0].texture->grained()) take_off_hollows();
  for (std::size_t i = 0; i < inked_.size(); ++i) {
    map_.fresh[i] *= inked_[i];
    map_.contact_s[i] *= inked_[i];
  }
}

}  // namespace fude

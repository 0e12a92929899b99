// What of the tufts stands over each cell of a footprint: its patch, and how much of its hair leaves ink.
//
// Hair that stays on the paper is looked up once a block of cells. Where streaks are open, newly covered
// cells are looked up one by one under the rim that passes over them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signal/ink_event.h"
#include "signal/paper_grain.h"
#include "sim/brush/contact_mesh.h"
#include "sim/brush/coverage.h"
#include "sim/brush/hair_quad.h"
#include "sim/brush/hair_texture.h"
#include "sim/brush/tuft_surface.h"

namespace fude {

// The hair of one tuft of a brush: its maps, and from which patch of the brush each patch of it (patch_at)
// has its ink.
struct TuftHair {
  const HairTexture* texture = nullptr;
  std::span<const std::uint16_t> patches;  // patch_count
};

// What hair is looked up by: tuft by tuft, the ink of the brush's patches, and the paper, none where its
// relief is unknown.
struct HairLook {
  std::span<const TuftHair> tufts;
  const std::vector<InkLoad>& loads;
  PaperGrain* grain = nullptr;
};

// Names the patches of a map's cells, and takes off the share of them under hair that leaves no ink.
class Stamp {
 public:
  // `map` is over `frame`; `widest` is the largest spread of the hair that is to be looked up. All outlive
  // the stamp; grain may be none.
  Stamp(const CoverageFrame& frame, const HairLook& look, double widest, FootprintMap& map);

  // Whether hair leaves white anywhere.
  bool streaky() const { return streaky_; }

  // Blocks in which `cover` holds a sample wait to be named, if they are not yet.
  void wait_for(const Coverage& cover);
  bool waits() const;
  // Names blocks that wait, those under the contact of a tuft.
  void add(std::size_t tuft, const Contact& contact);
  // Names what still waits, since it was never under a contact as thick as a block, after the nearest hair
  // of all tufts.
  void name_rest(std::span<const ContactMesh> contacts);

  // Over that, cells that hold a sample of `cover` wait to be written one by one.
  void wait_for_rim(const Coverage& cover);
  bool rim_waits() const;
  // Writes cells that wait under the rim of the contact of a tuft on its way from a to b.
  void add_passage(std::size_t tuft, const ContactMesh& a, const ContactMesh& b);

  // Takes off what is not inked, and what lies in the hollows of the paper.
  void finish();

 private:
  void take_up(std::size_t tuft);
  static constexpr int block_side = 4;  // cells

  HairCorner corner_at(const Eigen::Vector2d& at, double along, double around, const HairState& hair) const;
  float wetness_at(double along, double around) const;
  bool waits_under(const HairQuad& quad) const;
  void name_blocks(HairQuad quad);
  Hair hair_near(std::span<const ContactMesh> contacts, int row, int column);
  std::uint16_t patch_of(const Hair& hair) const;
  void write_block(int row, int column, const Hair& centre, const HairSlope& by_block);
  void write_cells(const HairQuad& quad);
  void write_cell(std::size_t cell, const Hair& hair);
  void take_off_hollows();

  const CoverageFrame& frame_;
  const HairLook look_;
  FootprintMap& map_;
  TuftHair now_;  // of the tuft that is being added
  bool streaky_ = false;
  std::vector<float> split_shift_;  // of each tuft
  float now_shift_ = 0;
  std::vector<float> inked_;  // of each cell, where streaky
  std::vector<float> reach_;
  std::vector<HairRow> rows_;

  // A bit a block, in rows of whole words.
  int block_columns_ = 0;
  int block_rows_ = 0;
  std::size_t block_words_ = 0;  // in a row
  std::vector<std::uint64_t> waiting_;
  std::vector<std::uint64_t> named_;

  std::vector<std::uint16_t> rim_;  // a bit a cell that waits, 16 in a row together
};

}  // namespace fude

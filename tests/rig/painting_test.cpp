#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <thread>

#include "rig/inputs.h"
#include "rig/live_painting.h"
#include "rig/replay.h"
#include "rig/share_folder.h"
#include "tests/rig/gesture.h"

namespace fude {
namespace {

using gesture::settings;

ReplayReport painted(const Session& session, const ReplaySettings& s) {
  return replay(session, s, [](double) {}).value().report;
}

double total_deposit(const ReplayReport& r) { return r.ink.pigment_deposited[0]; }

TEST(Replay, AStrokeLeavesInkAndIsCounted) {
  const ReplayReport r = painted(gesture::session(200, 2), settings());
  EXPECT_EQ(r.strokes, 2);
  EXPECT_EQ(r.samples, static_cast<std::int64_t>(gesture::session(200, 2).pens.size()));
  EXPECT_GT(total_deposit(r), 0.1);
  EXPECT_EQ(r.solves.unconverged, 0);
  EXPECT_NEAR(r.dt_s, 4.0 / 120, 1e-12);
}

TEST(Replay, WhatWasDepositedIsAccountedFor) {
  ReplaySettings s = settings();
  s.settle.seconds = 2;
  const ReplayReport r = painted(gesture::session(200, 3), s);
  const InkTotals& ink = r.ink;
  EXPECT_NEAR(ink.pigment_deposited[0], ink.pigment_surface[0] + ink.pigment_flow[0] + ink.pigment_fixed[0],
              1e-4 * ink.pigment_deposited[0]);
  EXPECT_NEAR(ink.water_deposited, ink.water_evaporated + ink.water_left, 1e-4 * ink.water_deposited);
  EXPECT_GT(ink.water_evaporated, 0);
}

TEST(Painting, WhatTheBrushLostIsOnThePaper) {
  PaintingSetup setup = settings().painting;
  setup.ink.width_mm = setup.ink.height_mm = gesture::sheet_mm;
  Painting painting = Painting::open(setup).value();
  const auto left_in_brush = [&] {
    double water = 0;
    double pigment = 0;
    const Loading& loading = painting.brush(PenEnd::tip).state().loading;
    const auto add = [&](const LoadedPatch& part) {
      water += part.water_ul;
      pigment += part.pigment_ul[0];
    };
    std::ranges::for_each(loading.patches, add);
    std::ranges::for_each(loading.inside, add);
    return std::pair(water, pigment);
  };
  const auto [water, pigment] = left_in_brush();
  const Session session = gesture::session(200, 2);
  bool waited = false;
  for (const TimedInput& input :
       inputs_of(session, plan_sheet(session, {}).value(), settings().reach, painting.step_s())) {
    painting.advance_to(input.step);
    const auto& move = std::get<BrushMove>(input.input);
    painting.move(move.end, move.input);
    waited = waited || painting.brush(PenEnd::tip).state().loading.set_aside.size() > 2;
  }
  EXPECT_TRUE(waited);
  painting.advance_to(painting.step() + 4);
  painting.act(Action{{}, ReshapeBrush{}});  // it hears the last answers
  EXPECT_TRUE(painting.brush(PenEnd::tip).state().loading.set_aside.empty());
  const InkTotals totals = painting.ink().totals();
  EXPECT_NEAR(water - left_in_brush().first, totals.water_deposited, 1e-4 * totals.water_deposited);
  EXPECT_NEAR(pigment - left_in_brush().second, totals.pigment_deposited[0],
              1e-4 * totals.pigment_deposited[0]);
  EXPECT_GT(totals.pigment_deposited[0], 0.1);
}

// A pose of an upright handle with the root of the tuft `height_mm` over (x, y).
BrushInput held_at(double t_s, double x_mm, double y_mm, double height_mm) {
  BrushInput input;
  input.time.host = Timestamp(Duration(static_cast<std::int64_t>(t_s * 1e9)));
  input.origin = PoseOrigin::measured;
  input.in_contact = true;
  input.paper_from_handle.translation = {x_mm, y_mm, height_mm};
  return input;
}

double pigment_in(const Brush& brush, std::size_t channel) {
  const Loading& loading = brush.state().loading;
  double sum = 0;
  for (const LoadedPatch& patch : loading.patches) sum += patch.pigment_ul[channel];
  for (const LoadedPatch& row : loading.inside) sum += row.pigment_ul[channel];
  return sum;
}

double pigment_on(const Ink& ink, const CellRect& cells, std::size_t channel) {
  double sum = 0;
  for (const Concentrations& amount : ink.read(cells).pigment) sum += static_cast<double>(amount[channel]);
  return sum * ink.cell_mm() * ink.cell_mm();
}

TEST(Painting, ACleanWetBrushPicksUpWetInkAndLeavesItFurtherOn) {
  PaintingSetup setup = settings().painting;
  setup.ink.width_mm = 80;
  setup.ink.height_mm = 30;
  setup.load = {0.9F, {1.2F, 0, 0, 0.1F}};
  Painting painting = Painting::open(setup).value();
  const double length = setup.brush.tuft_length_mm;
  double t = 0;
  // From x to x in steps of 5 ms at 40 mm/s, pressed a quarter of the tuft.
  const auto stroke = [&](double from_mm, double to_mm) {
    for (double x = from_mm; x <= to_mm; x += 0.2, t += 0.005) {
      painting.advance_to(static_cast<Step>(t / painting.step_s()));
      painting.move(PenEnd::tip, held_at(t, x, 15, 0.75 * length));
    }
    t += 0.005;
    painting.move(PenEnd::tip, held_at(t, to_mm, 15, 2 * length));
    t += 0.05;
    painting.advance_to(static_cast<Step>(t / painting.step_s()));
  };
  for (int pass = 0; pass < 4; ++pass) stroke(15, 25);  // more than the paper drinks
  const CellRect beyond{200, 0, 200, 150};              // x from 40 to 80 mm
  EXPECT_EQ(pigment_on(painting.ink(), beyond, 0), 0);

  painting.act({{}, BrushCare(LoadBrush{0.9F, {}})});  // clear water
  EXPECT_EQ(pigment_in(painting.brush(PenEnd::tip), 0), 0);
  const double on_paper = painting.ink().totals().pigment_deposited[0];
  stroke(15, 30);
  painting.act({{}, ReshapeBrush{}});  // it hears the last answers
  const double picked = pigment_in(painting.brush(PenEnd::tip), 0);
  EXPECT_NEAR(on_paper - painting.ink().totals().pigment_deposited[0], picked, 1e-4 * on_paper);
  stroke(50, 65);
  painting.act({{}, ReshapeBrush{}});
  const double left = pigment_on(painting.ink(), beyond, 0);
  std::printf("figure: of %.3f ul of wet ink a clean wet brush picks up %.3f and leaves %.3f further on\n",
              on_paper, picked, left);
  EXPECT_GT(picked, 0.005 * on_paper);
  EXPECT_GT(left, 0.05 * picked);
  EXPECT_NEAR(left + pigment_in(painting.brush(PenEnd::tip), 0), picked, 1e-3 * picked);
}

TEST(Painting, UndoTakesBackADip) {
  PaintingSetup setup = settings().painting;
  setup.ink.width_mm = setup.ink.height_mm = gesture::sheet_mm;
  for (const std::size_t kept : {0, 4}) {
    History history(Painting::open(setup).value(), kept);
    const auto bytes = [&] { return bytes_of(history.painting().brush(PenEnd::tip).state()); };
    const auto loaded = bytes();
    history.apply(Action{{}, BrushCare(RinseBrush{1})});
    history.apply(Action{{}, BrushCare(DipBrush{8, 0.5F, {1, 0, 0, 0}})});
    const auto dipped = bytes();
    EXPECT_NE(dipped, loaded);
    history.apply(Action{{}, Undo{}});
    history.apply(Action{{}, Undo{}});
    EXPECT_EQ(bytes(), loaded);
    history.apply(Action{{}, Redo{}});
    history.apply(Action{{}, Redo{}});
    EXPECT_EQ(bytes(), dipped);
  }
}

TEST(Replay, ThreadsDoNotChangeThePicture) {
  const Session session = gesture::session(150, 2);
  EXPECT_EQ(painted(session, settings(1)).picture_sha256, painted(session, settings(2)).picture_sha256);
}

TEST(Replay, TellsTheForceOfEveryPaintedSample) {
  const Session session = gesture::session(150, 2);
  const std::vector<SolvedForce> forces = replay(session, settings(), [](double) {})->forces;
  ASSERT_GT(forces.size(), 100);
  double hardest = 0;
  for (const SolvedForce& f : forces) {
    EXPECT_GE(f.on_hand.force_n.z(), -1e-9);  // paper pushes up
    hardest = std::max(hardest, f.on_hand.force_n.norm());
  }
  EXPECT_GT(hardest, 0.005);  // newtons: a soft tuft under a hand
  EXPECT_LT(hardest, 2);
  std::printf("figure: the brush pushes the hand with up to %.3f N in the scripted gesture\n", hardest);
}

// Release builds, sanitizers and other compilers are held to the same picture. It changes with the physics of
// brush, ink or colour, and then on purpose.
TEST(Replay, IsTheSamePictureInEveryBuild) {
  ReplaySettings s = settings();
  s.settle.seconds = 1;
  EXPECT_EQ(painted(gesture::session(150, 2), s).picture_sha256,
            "49e2517482bff5c8c70dc4561e75ac8e5b443ab7b8bf78823ca0ab7330ee2e2e");
  EXPECT_EQ(painted(gesture::calibrated(gesture::session(150, 2)), s).picture_sha256,
            "4bcf254aad7312fccc447ffd60fc7730cec6f9dce63a66012cbd61272c854d51");
}

TEST(Replay, TheRateOfTheTabletDoesNotChangeTheDeposit) {
  ReplaySettings round_goat = settings();
  ReplaySettings standard = settings();
  standard.painting.brush = BrushSpec{};
  standard.reach = reach_of(BrushSpec{});
  for (const ReplaySettings& s : {round_goat, standard}) {
    const double slow = total_deposit(painted(gesture::session(100, 1), s));
    const double middle = total_deposit(painted(gesture::session(250, 1), s));
    const double fast = total_deposit(painted(gesture::session(1000, 1), s));
    EXPECT_NEAR(slow, fast, 0.02 * fast);
    EXPECT_NEAR(middle, fast, 0.02 * fast);
  }
}

TEST(Replay, PressureWithoutContactPaintsNothing) {
  Session session = gesture::session(200, 1);
  for (RecordedPen& pen : session.pens) pen.sample.in_contact = false;
  const ReplayReport r = painted(session, settings());
  EXPECT_EQ(total_deposit(r), 0);
  EXPECT_EQ(r.strokes, 0);
}

TEST(Replay, DryingEndsWhenAllWaterIsGone) {
  ReplaySettings s = settings();
  s.settle.until_dry = true;
  const ReplayReport r = painted(gesture::session(200, 1), s);
  EXPECT_EQ(r.ink.water_left, 0);
  EXPECT_EQ(r.ink.pigment_flow[0], 0);
  EXPECT_NEAR(r.ink.pigment_fixed[0], total_deposit(r), 1e-4 * total_deposit(r));
}

TEST(Replay, TheRubberEndCarriesClearWater) {
  Session session = gesture::session(200, 1);
  for (RecordedPen& pen : session.pens) pen.sample.tool = PenTool::rubber;
  const ReplayReport r = painted(session, settings());
  EXPECT_GT(r.ink.water_deposited, 0);
  EXPECT_EQ(total_deposit(r), 0);
}

History fresh(std::size_t kept) {
  PaintingSetup setup = settings().painting;
  setup.ink.width_mm = setup.ink.height_mm = gesture::sheet_mm;
  return History(Painting::open(setup).value(), kept);
}

std::vector<TimedInput> inputs(const Session& session) {
  return inputs_of(session, plan_sheet(session, {}).value(), settings().reach, 4.0 / 120);
}

void run(History& history, const std::vector<TimedInput>& all) {
  for (const TimedInput& input : all) {
    history.advance_to(input.step);
    history.apply(input.input);
  }
}

TEST(Undo, GivesThePaintingAsItWasBeforeTheStroke) {
  History once = fresh(8);
  run(once, inputs(gesture::session(200, 1)));
  once.advance_to(once.step() + 4);  // the second stroke below begins here

  for (const std::size_t kept : {std::size_t{0}, std::size_t{1}, std::size_t{8}}) {
    History twice = fresh(kept);
    run(twice, inputs(gesture::session(200, 2)));
    const Step reached = twice.step();
    const Step second = [&] {
      for (const TimedInput& input : inputs(gesture::session(200, 2)))
        if (const auto* m = std::get_if<BrushMove>(&input.input);
            m && m->input.in_contact && input.step > once.step() - 8)
          return input.step;
      return Step{0};
    }();
    twice.apply(Action{{}, Undo{}});
    EXPECT_EQ(twice.step(), reached);  // the session's clock goes on
    History until = fresh(8);
    auto first = inputs(gesture::session(200, 2));
    std::erase_if(first, [&](const TimedInput& i) { return i.step > second; });
    while (!first.empty() && std::get<BrushMove>(first.back().input).input.in_contact) first.pop_back();
    run(until, first);
    until.advance_to(second);
    EXPECT_EQ(twice.painting().ink().hash(), until.painting().ink().hash()) << kept << " snapshots kept";
  }
}

TEST(Undo, AndRedoGiveThePictureBack) {
  History history = fresh(4);
  run(history, inputs(gesture::session(200, 2)));
  const std::uint64_t before = history.painting().ink().hash();
  EXPECT_TRUE(history.can_undo());
  history.apply(Action{{}, Undo{}});
  EXPECT_NE(history.painting().ink().hash(), before);
  EXPECT_TRUE(history.can_redo());
  history.apply(Action{{}, Redo{}});
  EXPECT_EQ(history.painting().ink().hash(), before);
  EXPECT_FALSE(history.can_redo());
}

TEST(Undo, OfEverythingLeavesABlankSheet) {
  History history = fresh(1);
  run(history, inputs(gesture::session(200, 3)));
  while (history.can_undo()) history.apply(Action{{}, Undo{}});
  EXPECT_EQ(history.painting().ink().totals().pigment_deposited[0], 0);
  history.apply(Action{{}, Undo{}});  // nothing left: nothing happens
}

// Paints the script live, records that, and paints the record again. Gives the picture of both.
std::string painted_live_and_again(const Session& script, const std::string& name) {
  const auto path =
      std::filesystem::temp_directory_path() / ("fude-" + name + "-" + std::to_string(getpid()) + ".fude");
  std::filesystem::remove(path);
  const SheetPlan plan = plan_sheet(script, {}).value();
  ReplaySettings s = settings(2);
  PaintingSetup setup = s.painting;
  setup.ink.width_mm = plan.sheet.width.value;
  setup.ink.height_mm = plan.sheet.height.value;

  std::string live_picture;
  Step end = 0;
  double step_s = 0;
  {
    auto recorder = Recorder::open(path).value();
    for (const RecordedCalibration& carried : script.calibrations) recorder->add(carried);
    recorder->add(script.devices[0].description);
    LivePainting live(Painting::open(setup).value(), s.reach, recorder.get());
    for (const RecordedPen& pen : script.pens) {
      live.pen({1, pen.sample, plan.mappings.at(1)});
      if (pen.order == 90) live.act({pen.sample.time.host, BrushCare(LoadBrush{0.6F, {0.5F, 0, 0, 0}})});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    live.act({{}, Undo{}});
    live.act({{}, Redo{}});
    History& history = live.stop();
    history.advance_to(history.step() + 1);
    end = history.step();
    step_s = history.painting().step_s();
    live_picture = picture_sha256(picture_of(history.painting().ink(), s.palette));
    EXPECT_TRUE(recorder->close());
  }
  const Session recorded = read_session(path).value();
  EXPECT_EQ(recorded.pens.size(), script.pens.size());
  // The live painting may have gone on for some steps after the last input; a replay goes on for one.
  const Step after = end - recorded.actions.back().applied.value() - 1;
  s.settle.seconds = static_cast<double>(after) * step_s;
  EXPECT_EQ(painted(recorded, s).picture_sha256, live_picture);
  std::filesystem::remove(path);
  return live_picture;
}

TEST(LivePainting, AReplayOfWhatWasPaintedLiveIsTheSamePicture) {
  painted_live_and_again(gesture::session(200, 2), "live");
}

TEST(LivePainting, ACalibratedTabletPaintsTheSameInAReplay) {
  painted_live_and_again(gesture::calibrated(gesture::session(200, 2)), "calibrated");
}

TEST(Replay, TheCalibrationThatTheSessionCarriesMovesTheStroke) {
  const Session plain = gesture::session(150, 1);
  const Session calibrated = gesture::calibrated(plain);
  EXPECT_NE(painted(plain, settings()).picture_sha256, painted(calibrated, settings()).picture_sha256);
  Session without = calibrated;
  without.calibrations.clear();
  EXPECT_EQ(painted(plain, settings()).picture_sha256, painted(without, settings()).picture_sha256);
}

// An ink on a card that is full after some steps.
class FullCard final : public Ink {
 public:
  FullCard(std::unique_ptr<Ink> ink, int steps) : ink_(std::move(ink)), steps_left_(steps) {}
  int columns() const override { return ink_->columns(); }
  int rows() const override { return ink_->rows(); }
  double cell_mm() const override { return ink_->cell_mm(); }
  double step_s() const override { return ink_->step_s(); }
  void apply(const InkEvent& event) override { ink_->apply(event); }
  void step() override {
    if (steps_left_-- == 0) throw std::runtime_error("the card is full");
    ink_->step();
  }
  std::vector<Exchange> collect() override { return ink_->collect(); }
  InkTotals totals() const override { return ink_->totals(); }
  std::uint64_t steps() const override { return ink_->steps(); }
  std::size_t active_cells() const override { return ink_->active_cells(); }
  CellRect active_rect() const override { return ink_->active_rect(); }
  bool still() const override { return ink_->still(); }
  InkRegion read(const CellRect& rect) const override { return ink_->read(rect); }
  InkSnapshot snapshot(InkSnapshot memory) const override { return ink_->snapshot(std::move(memory)); }
  void restore(const InkSnapshot& snapshot) override { ink_->restore(snapshot); }
  std::uint64_t hash() const override { return ink_->hash(); }

 private:
  std::unique_ptr<Ink> ink_;
  int steps_left_;
};

TEST(LivePainting, EndsInOneLineWhereTheCardGivesOut) {
  const ReplaySettings s = settings();
  LivePainting live(Painting(s.painting, std::make_unique<FullCard>(open_ink(s.painting.ink).value(), 3)),
                    s.reach, nullptr);
  while (!live.failed()) std::this_thread::yield();
  EXPECT_EQ(live.failed()->message, "the card is full");
  live.act({{}, ReshapeBrush{}});
  EXPECT_EQ(live.stop().step(), 4);  // the one that it was asked for and could not do
}

}  // namespace
}  // namespace fude

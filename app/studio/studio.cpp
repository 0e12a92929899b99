#include "app/studio/studio.h"

#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <utility>

#include "app/painting_options.h"
#include "app/studio/care_choice.h"
#include "app/studio/mouse_pen.h"
#include "app/studio/panel.h"
#include "app/studio/sheet_image.h"
#include "app/studio/tuft_drawing.h"
#include "app/studio/view.h"
#include "app/studio/window.h"
#include "rig/calibration/passport.h"
#include "rig/devices.h"
#include "rig/live_painting.h"
#include "rig/session_summary.h"
#include "sim/optics/png_file.h"

namespace fude {
namespace {

using StudioClock = std::chrono::steady_clock;  // CLOCK_MONOTONIC, as the rig's

Timestamp now() {
  return Timestamp(std::chrono::duration_cast<Duration>(StudioClock::now().time_since_epoch()));
}

// The largest tablet that is there, as a replay will have it; else A5.
Extent sheet_for_the_hand(const std::vector<CalibratedTablet>& calibrated,
                          const std::optional<Extent>& told) {
  Extent sheet;
  if (const auto found = attached_devices())
    for (const AttachedDevice& tablet : *found)
      if (const auto area = area_of(calibrated, sized(tablet.description, told)); area && tablet.access) {
        sheet.width = std::max(sheet.width, area->width);
        sheet.height = std::max(sheet.height, area->height);
      }
  if (sheet.width.value > 0) return sheet;
  return {Millimetres(210), Millimetres(148)};
}

// Saved pictures get the first free name.
std::string free_picture_name() {
  for (int i = 1;; ++i) {
    const std::string name = "fude-" + std::to_string(i) + ".png";
    if (!std::filesystem::exists(name)) return name;
  }
}

class Studio {
 public:
  Studio(const StudioSetup& setup, const SheetPlan& plan, Painting painting, Recorder* recorder)
      : setup_(setup),
        plan_(plan),
        sheet_mm_(plan.sheet.width.value, plan.sheet.height.value),
        columns_(painting.ink().columns()),
        rows_(painting.ink().rows()),
        step_ms_(painting.step_s() * 1e3),
        mouse_{.sheet = plan.sheet},
        passport_(setup.settings.wish.calibrations),
        live_(std::move(painting), setup.settings.reach, recorder, plan.manner, plan.sheet) {
    if (setup.played)
      for (const RecordedDevice& device : setup.played->devices) {
        numbers_[device.number] = ++devices_;
        if (!recorder) continue;
        for (const RecordedCalibration& own : passport_.begin(device.description)) recorder->add(own);
        recorder->add(device.description);
      }
    const DeviceDescription mouse = mouse_description(plan.sheet);
    mouse_device_ = ++devices_;
    if (recorder) recorder->add(mouse);
    mouse_mapping_ = *mapping_for(mouse, plan.sheet);
    if (setup.script.empty()) listen_to_tablets(recorder);
  }

  Result<void> run() {
    auto window = Window::open("fude", events());
    if (!window) return tl::unexpected(window.error());
    window_ = std::move(*window);
    image_.emplace(columns_, rows_, setup_.settings.palette);
    tuft_.emplace(setup_.settings.palette);
    view_.window = window_->size();
    view_.fit(sheet_mm_);
    start_ = looked_ = now();
    while (!quitting_ && window_->begin_frame()) {
      view_.window = window_->size();
      inject();
      play();
      if (const auto changes = live_.take_changes()) image_->show(*changes);
      draw();
      window_->draw_frame();
      take_shots();
      window_->end_frame();
      if (auto ended = live_.failed()) failed_ = std::move(ended);
      if (failed_) break;
    }
    image_.reset();
    tuft_.reset();
    window_.reset();
    if (failed_) return tl::unexpected(*failed_);
    return {};
  }

  // The brush leaves the paper, and the sheet is what a replay of the session makes of it.
  Picture finish() {
    tablets_.reset();
    mouse_.over_paper = mouse_.pressed = false;
    send_mouse();
    History& history = live_.stop();
    history.advance_to(history.step() + 1);
    return picture_of(history.painting().ink(), setup_.settings.palette);
  }

 private:
  struct KnownTablet {
    DeviceNumber number;
    std::optional<TabletMapping> mapping;  // none: its size is not known
    bool near = false;                     // a pen is over it
  };

  // Their readers hand samples to the painting on their own threads. Without udev there is the mouse.
  void listen_to_tablets(Recorder* recorder) {
    DeviceListener listener;
    // With the size that was told: so a replay has it too.
    listener.appeared = [this, recorder](std::size_t, const DeviceDescription& stated) {
      const DeviceDescription description = sized(stated, setup_.settings.wish.tablet);
      const auto mapping = mapping_on(plan_, description);
      const std::lock_guard lock(tablets_mutex_);
      if (recorder) {
        for (const RecordedCalibration& own : passport_.begin(description)) recorder->add(own);
        recorder->add(description);
      }
      known_tablets_.push_back({++devices_, mapping ? std::optional(*mapping) : std::nullopt, false});
      if (!mapping) notice_ = mapping.error().message;
    };
    listener.heard = [this, recorder](std::size_t tablet, const Transfer& transfer,
                                      std::span<const Sample> samples) {
      const std::lock_guard lock(tablets_mutex_);
      KnownTablet& known = known_tablets_[tablet];
      if (recorder) recorder->add(RecordedTransfer{known.number, transfer});
      for (const Sample& sample : samples)
        if (const auto* pen = std::get_if<PenSample>(&sample)) hear_pen(known, *pen);
    };
    listener.refused = [this](const Error& error) {
      const std::lock_guard lock(tablets_mutex_);
      notice_ = error.message;
    };
    const auto wanted = [](const AttachedDevice& device) {
      return device.description.kind == DeviceKind::pen_tablet;
    };
    if (auto opened = Devices::open(std::move(listener), {.wanted = wanted, .named = {}}))
      tablets_ = std::move(*opened);
  }

  void hear_pen(KnownTablet& known, const PenSample& pen) {
    known.near = pen.in_proximity;
    pen_near_ = std::ranges::any_of(known_tablets_, &KnownTablet::near);
    if (!known.mapping) return;
    live_.pen({known.number, pen, *known.mapping});
    mouse_shown_ = false;
  }

  WindowEvents events() {
    // The desktop moves its pointer with the pen of a tablet: that is no second hand.
    return {.moved =
                [this](const Eigen::Vector2d& at) {
                  if (!pen_near_) move_to(view_.to_paper(at));
                },
            .button =
                [this](bool pressed) {
                  if (!pen_near_) handle(Button{pressed});
                },
            .dragged = [this](const Eigen::Vector2d& by) { view_.pan(by); },
            .scrolled = [this](double notches,
                               const Eigen::Vector2d& at) { view_.zoom(notches > 0 ? 1.15 : 1 / 1.15, at); },
            .key = [this](const std::string& key) { press_key(key); }};
  }

  void press_key(const std::string& key) {
    if (key == "Ctrl+Z") handle(StudioKey::undo);
    if (key == "Shift+Ctrl+Z" || key == "Ctrl+Y") handle(StudioKey::redo);
    if (key == "L") handle(StudioKey::load);
    if (key == "G") handle(StudioKey::gradient);
    if (key == "I") handle(StudioKey::dip);
    if (key == "W") handle(StudioKey::rinse);
    if (key == "E") handle(StudioKey::wipe);
    if (key == "B") handle(StudioKey::blot);
    if (key == "O") handle(StudioKey::roll);
    if (key == "R") handle(StudioKey::reshape);
    if (key == "D") handle(StudioKey::dry);
    if (key == "F") handle(StudioKey::fit);
    if (key == "S" || key == "Ctrl+S") handle(SaveAs{free_picture_name()});
  }

  void handle(const StudioEvent& event) {
    std::visit([this](const auto& what) { on(what); }, event);
  }
  void on(const MoveTo& to) { move_to({to.x_mm, to.y_mm}); }
  void on(const Button& button) {
    mouse_.pressed = button.pressed;
    send_mouse();
  }
  void on(const Press& press) {
    mouse_.pressure = press.pressure;
    send_mouse();
  }
  void on(const Zoom& zoom) { view_.zoom(zoom.factor, 0.5 * view_.window); }
  void on(const SaveAs& save) {
    const auto done = write_png(save.file, image_->picture(), {.overwrite = setup_.overwrite});
    if (!done) failed_ = done.error();
    saved_ = save.file;
  }
  void on(const Shot& shot) { shots_.push_back(shot.file); }
  void on(const Look& look) { display_ = {look.hair, look.development}; }
  void on(const Quit&) { quitting_ = true; }
  void on(StudioKey key) {
    if (const auto care = care_for(key, care_)) return live_.act({now(), *care});
    switch (key) {
      case StudioKey::undo:
        live_.act({now(), Undo{}});
        break;
      case StudioKey::redo:
        live_.act({now(), Redo{}});
        break;
      case StudioKey::reshape:
        live_.act({now(), ReshapeBrush{}});
        break;
      case StudioKey::dry:
        live_.act({now(), DrySheet{}});
        break;
      case StudioKey::fit:
        view_.fit(sheet_mm_);
        break;
      default:
        break;
    }
  }

  void move_to(const Eigen::Vector2d& mm) {
    mouse_.at_mm = mm;
    mouse_.over_paper = (mm.x() >= 0 && mm.y() >= 0 && mm.x() <= sheet_mm_.x() && mm.y() <= sheet_mm_.y()) ||
                        spot_at(setup_.settings.painting.spots, mm.x(), mm.y()) != nullptr;
    send_mouse();
  }

  void send_mouse() {
    live_.pen({mouse_device_, mouse_.sample(hand_time_.value_or(now())), mouse_mapping_});
    mouse_shown_ = true;
  }

  // The scripted hand waits for a window that is slow: what it did shows before it goes on.
  void inject() {
    constexpr Duration longest_frame = std::chrono::milliseconds(50);
    const Timestamp present = now();
    scripted_ += std::min(present - looked_, longest_frame);
    looked_ = present;
    while (next_scripted_ < setup_.script.size() && !quitting_) {
      const ScriptedEvent& event = setup_.script[next_scripted_];
      const auto at = std::chrono::duration_cast<Duration>(std::chrono::duration<double>(event.at_s));
      if (at > scripted_) break;
      ++next_scripted_;
      hand_time_ = present - (scripted_ - at);
      handle(event.what);
    }
    hand_time_.reset();
  }

  // The recorded hand moves here as it moved then.
  void play() {
    if (!setup_.played) return;
    const Session& session = *setup_.played;
    const Timestamp began = span_of(session).first;
    const Duration reached = now() - start_;
    for (; next_pen_ < session.pens.size() && session.pens[next_pen_].sample.time.host - began <= reached;
         ++next_pen_) {
      const RecordedPen& pen = session.pens[next_pen_];
      const auto mapping = plan_.mappings.find(pen.device);
      if (mapping == plan_.mappings.end()) continue;
      LivePen live{numbers_[pen.device], pen.sample, mapping->second};
      live.sample.time.host = start_ + (pen.sample.time.host - began);
      live_.pen(std::move(live));
      mouse_shown_ = false;
    }
    for (; next_action_ < session.actions.size() &&
           session.actions[next_action_].action.time - began <= reached;
         ++next_action_)
      live_.act(session.actions[next_action_].action);
  }

  void take_shots() {
    for (const std::string& file : std::exchange(shots_, {}))
      if (auto done = write_png(file, window_->shown(), {.depth = 8, .overwrite = setup_.overwrite}); !done)
        failed_ = done.error();
  }

  void draw_brush(ImDrawList& canvas, const LiveStatus& status) {
    tuft_->draw(canvas, view_, status.hair, display_.development ? TuftLook::outline : display_.look);
    // What did not converge is seen for a while, though the next frame may be good again.
    constexpr Duration seen_for = std::chrono::milliseconds(300);
    if (status.unconverged > unconverged_) unconverged_at_ = now();
    unconverged_ = status.unconverged;
    const bool converged = !unconverged_at_ || now() - *unconverged_at_ > seen_for;
    if (display_.development) draw_insides(canvas, view_, status.brush, status.insides, converged);
  }

  void draw() {
    const LiveStatus status = live_.status();
    ImDrawList& canvas = *ImGui::GetBackgroundDrawList();
    const Eigen::Vector2d top_left = view_.to_window({0, sheet_mm_.y()});
    const Eigen::Vector2d bottom_right = view_.to_window({sheet_mm_.x(), 0});
    const auto point = [](const Eigen::Vector2d& p) {
      return ImVec2(static_cast<float>(p.x()), static_cast<float>(p.y()));
    };
    image_->sharpen(view_.pixels_per_mm * sheet_mm_.x() > 2 * columns_);
    canvas.AddRectFilled(point(top_left + Eigen::Vector2d(4, 5)), point(bottom_right + Eigen::Vector2d(4, 5)),
                         IM_COL32(0, 0, 0, 70));
    canvas.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(image_->texture())),
                    point(top_left), point(bottom_right));
    for (const PlacedSpot& spot : setup_.settings.painting.spots) {
      const ImVec2 centre = point(view_.to_window({spot.x_mm, spot.y_mm}));
      canvas.AddCircle(centre, static_cast<float>(spot.radius_mm * view_.pixels_per_mm),
                       IM_COL32(230, 225, 215, 255), 0, 2);
      if (!std::holds_alternative<Rim>(spot.spot))
        canvas.AddText(centre, IM_COL32(230, 225, 215, 255), spot.name.c_str());
    }
    if (pen_near_ && !ImGui::GetIO().WantCaptureMouse) ImGui::SetMouseCursor(ImGuiMouseCursor_None);
    if (status.pen.in_proximity) draw_brush(canvas, status);
    const PanelChoice choice =
        draw_panel(status, mouse_shown_, mouse_, display_, step_ms_, setup_.settings.palette.pigments, care_);
    if (choice.key) handle(*choice.key);
    if (choice.save) handle(SaveAs{free_picture_name()});
    const std::lock_guard lock(tablets_mutex_);
    const std::string line = saved_.empty() ? notice_ : "saved " + saved_;
    canvas.AddText(ImVec2(12, static_cast<float>(view_.window.y()) - 24), IM_COL32(255, 255, 255, 255),
                   line.c_str());
  }

  const StudioSetup& setup_;
  const SheetPlan& plan_;
  Eigen::Vector2d sheet_mm_;
  int columns_;
  int rows_;
  double step_ms_;
  MousePen mouse_;
  CareChoice care_;
  TabletMapping mouse_mapping_;
  std::map<DeviceNumber, DeviceNumber> numbers_;  // of the played session's devices, here
  DeviceNumber devices_ = 0;
  DeviceNumber mouse_device_ = 0;
  Passport passport_;  // of the calibrations that were named or are kept
  LivePainting live_;
  std::mutex tablets_mutex_;
  std::vector<KnownTablet> known_tablets_;
  std::string notice_;  // what a tablet lacks
  std::unique_ptr<Devices> tablets_;
  std::unique_ptr<Window> window_;
  std::optional<SheetImage> image_;
  std::optional<TuftDrawing> tuft_;
  BrushDisplay display_;
  std::int64_t unconverged_ = 0;
  std::optional<Timestamp> unconverged_at_;
  View view_;
  Timestamp start_{};
  std::optional<Timestamp> hand_time_;  // of a scripted event; none: the present
  Duration scripted_{0};                // how far the script is
  Timestamp looked_{};                  // when that was last moved on
  std::size_t next_scripted_ = 0;
  std::size_t next_pen_ = 0;
  std::size_t next_action_ = 0;
  std::atomic<bool> mouse_shown_ = true;
  std::atomic<bool> pen_near_ = false;
  bool quitting_ = false;
  std::string saved_;
  std::vector<std::string> shots_;  // of the window, wanted at the end of this frame
  std::optional<Error> failed_;
};

}  // namespace

Result<void> run_studio(const StudioSetup& setup) {
  const Session blank;
  SheetWish wish = setup.settings.wish;
  if (!setup.played && !wish.sheet) {
    const auto calibrated = calibrated_tablets(wish.calibrations);
    if (!calibrated) return tl::unexpected(calibrated.error());
    wish.sheet = sheet_for_the_hand(*calibrated, wish.tablet);
  }
  const auto plan = plan_sheet(setup.played ? *setup.played : blank, wish);
  if (!plan) return tl::unexpected(plan.error());
  PaintingSetup painting_setup = setup.settings.painting;
  painting_setup.ink.width_mm = plan->sheet.width.value;
  painting_setup.ink.height_mm = plan->sheet.height.value;
  auto painting = Painting::open(painting_setup);
  if (!painting) return tl::unexpected(painting.error());
  if (setup.sheet)
    if (auto laid = lay_sheet(*setup.sheet, painting->ink()); !laid) return laid;
  std::unique_ptr<Recorder> recorder;
  if (!setup.out.empty()) {
    auto opened = Recorder::open(setup.out);
    if (!opened) return tl::unexpected(opened.error());
    recorder = std::move(*opened);
    for (const auto& [key, value] : setup.settings.to_record) recorder->add(SessionSetting{key, value});
    recorder->add(SessionSetting{"sheet_mm", as_text(plan->sheet)});
    if (setup.sheet) recorder->add(RecordedSheet{0, as_bytes(*setup.sheet)});
    if (setup.played)
      for (const RecordedCalibration& carried : setup.played->calibrations) recorder->add(carried);
  }
  Studio studio(setup, *plan, std::move(*painting), recorder.get());
  if (auto done = studio.run(); !done) return done;
  const Picture sheet = studio.finish();
  if (recorder)
    if (auto closed = recorder->close(); !closed) return closed;
  if (setup.picture.empty()) return {};
  return write_png(setup.picture, sheet, {.overwrite = setup.overwrite});
}

}  // namespace fude

#include "capture/copy_session.h"

#include <algorithm>
#include <variant>

namespace fude {
namespace {

// An input of any kind, to be put back into one order.
struct Input {
  InputOrder order = 0;
  std::variant<const RecordedPen*, const RecordedSample*, const RecordedAction*> what;
};

std::vector<Input> inputs_of(const Session& session) {
  std::vector<Input> inputs;
  for (const RecordedPen& pen : session.pens) inputs.push_back({pen.order, &pen});
  for (const RecordedSample& sample : session.samples) inputs.push_back({sample.order, &sample});
  for (const RecordedAction& action : session.actions) inputs.push_back({action.order, &action});
  std::stable_sort(inputs.begin(), inputs.end(),
                   [](const Input& a, const Input& b) { return a.order < b.order; });
  return inputs;
}

class Copy {
 public:
  Copy(const Session& session, SessionWriter& to) : session_(session), to_(to) {}

  Result<void> write() {
    for (const auto& [key, value] : session_.settings) keep(to_.set(key, value));
    if (session_.sheet) keep(to_.set_sheet(*session_.sheet));
    for (const RecordedCalibration& calibration : session_.calibrations)
      keep(to_.add_calibration(calibration));
    for (const RecordedDevice& device : session_.devices) {
      const auto number = to_.add_device(device.description);
      if (!number) return tl::unexpected(number.error());
      numbers_[device.number] = *number;
    }
    for (const RecordedTransfer& t : session_.transfers)
      keep(to_.add_transfer(number_of(t.device), t.transfer));
    for (const Input& input : inputs_of(session_)) std::visit([this](const auto* i) { add(*i); }, input.what);
    for (Receipt receipt : session_.receipts) {
      receipt.device = number_of(receipt.device);
      keep(to_.add_receipt(receipt));
    }
    for (RecordedClockFit fit : session_.clock_fits) {
      fit.device = number_of(fit.device);
      keep(to_.add_clock_fit(fit));
    }
    for (PassedOver passed : session_.passed_over) {
      passed.device = number_of(passed.device);
      keep(to_.add_passed_over(passed));
    }
    return done_;
  }

 private:
  void keep(Result<void> written) {
    if (done_) done_ = std::move(written);
  }
  DeviceNumber number_of(DeviceNumber device) const {
    const auto found = numbers_.find(device);
    return found == numbers_.end() ? device : found->second;
  }
  void applied(const Result<InputOrder>& input, const std::optional<Step>& step) {
    if (!input)
      keep(tl::unexpected(input.error()));
    else if (step)
      keep(to_.applied(*input, *step));
  }
  void add(const RecordedPen& pen) {
    applied(to_.add_sample(number_of(pen.device), pen.sample), pen.applied);
  }
  void add(const RecordedSample& sample) {
    applied(to_.add_sample(number_of(sample.device), sample.sample), std::nullopt);
  }
  void add(const RecordedAction& action) { applied(to_.add_action(action.action), action.applied); }

  const Session& session_;
  SessionWriter& to_;
  std::map<DeviceNumber, DeviceNumber> numbers_;
  Result<void> done_;
};

}  // namespace

Result<void> copy_session(const Session& session, SessionWriter& to) { return Copy(session, to).write(); }

}  // namespace fude

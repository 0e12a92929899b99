#include "rig/recorder.h"

#include <chrono>
#include <utility>

#include "capture/session_writer.h"

namespace fude {
namespace {

constexpr std::chrono::milliseconds between_flushes{25};

}  // namespace

class Recorder::Writing {
 public:
  explicit Writing(SessionWriter out) : out_(std::move(out)) {}

  Result<void> operator()(const SessionSetting& s) { return out_.set(s.key, s.value); }
  Result<void> operator()(const DeviceDescription& d) { return drop_value(out_.add_device(d)); }
  Result<void> operator()(const RecordedTransfer& t) { return out_.add_transfer(t.device, t.transfer); }
  Result<void> operator()(const Receipt& r) { return out_.add_receipt(r); }
  Result<void> operator()(const RecordedCalibration& c) { return out_.add_calibration(c); }
  Result<void> operator()(const RecordedSheet& s) { return out_.set_sheet(s); }
  Result<void> operator()(const RecordedPen& p) {
    return with_step(out_.add_sample(p.device, p.sample), p.applied);
  }
  Result<void> operator()(const RecordedSample& s) { return drop_value(out_.add_sample(s.device, s.sample)); }
  Result<void> operator()(const RecordedClockFit& f) { return out_.add_clock_fit(f); }
  Result<void> operator()(const RecordedAction& a) { return with_step(out_.add_action(a.action), a.applied); }

  Result<void> flush() { return out_.flush(); }
  Result<void> close() { return out_.close(); }

 private:
  template <class T>
  static Result<void> drop_value(const Result<T>& r) {
    if (!r) return tl::unexpected(r.error());
    return {};
  }
  Result<void> with_step(const Result<InputOrder>& order, std::optional<Step> step) {
    if (!order) return tl::unexpected(order.error());
    return step ? out_.applied(*order, *step) : Result<void>{};
  }

  SessionWriter out_;
};

Result<std::unique_ptr<Recorder>> Recorder::open(const std::filesystem::path& path) {
  auto out = SessionWriter::create(path);
  if (!out) return tl::unexpected(out.error());
  return std::unique_ptr<Recorder>(new Recorder(std::make_unique<Writing>(std::move(*out))));
}

Recorder::Recorder(std::unique_ptr<Writing> writing)
    : writing_(std::move(writing)), thread_([this] { serve(); }) {}

Recorder::~Recorder() { (void)close(); }

void Recorder::add(SessionRecord record) {
  const std::lock_guard lock(mutex_);
  queue_.push_back(std::move(record));
}

std::optional<Error> Recorder::failed() const {
  const std::lock_guard lock(mutex_);
  return failed_;
}

void Recorder::serve() {
  std::vector<SessionRecord> batch;
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, between_flushes, [this] { return closing_; });
      last = closing_;
      std::swap(batch, queue_);
    }
    Result<void> written;
    for (const SessionRecord& record : batch) {
      written = std::visit(*writing_, record);
      if (!written) break;
    }
    if (written) written = writing_->flush();
    batch.clear();
    const std::lock_guard lock(mutex_);
    if (!written && !failed_) failed_ = written.error();
  }
}

Result<void> Recorder::close() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    wake_.notify_one();
    thread_.join();
    if (auto r = writing_->close(); !r && !failed_) failed_ = r.error();
  }
  if (failed_) return tl::unexpected(*failed_);
  return {};
}

}  // namespace fude

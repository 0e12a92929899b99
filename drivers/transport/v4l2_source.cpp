#include "drivers/transport/v4l2_source.h"

#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "drivers/transport/device_node.h"

namespace fude {
namespace {

constexpr std::uint32_t buffer_count = 4;  // one with us, the others filling
constexpr double exposure_unit_s = 1e-4;   // of V4L2_CID_EXPOSURE_ABSOLUTE

int ask(int file, unsigned long request, void* argument) {
  int status = 0;
  do status = ioctl(file, request, argument);
  while (status < 0 && errno == EINTR);
  return status;
}

std::uint32_t code_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::grey:
      return V4L2_PIX_FMT_GREY;
    case PixelFormat::yuyv:
      return V4L2_PIX_FMT_YUYV;
    case PixelFormat::mjpeg:
      return V4L2_PIX_FMT_MJPEG;
    case PixelFormat::png:
      break;
  }
  return 0;
}

ExposureMoment moment_of(std::uint32_t flags) {
  switch (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) {
    case V4L2_BUF_FLAG_TSTAMP_SRC_SOE:
      return ExposureMoment::start;
    case V4L2_BUF_FLAG_TSTAMP_SRC_EOF:
      return ExposureMoment::end;
    default:
      return ExposureMoment::unknown;
  }
}

v4l2_buffer capture_buffer() {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

}  // namespace

// One of the driver's buffers in our memory.
class V4l2Source::Mapping {
 public:
  Mapping(int file, const v4l2_buffer& buffer)
      : start_(mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, file, buffer.m.offset)),
        size_(buffer.length) {}
  Mapping(Mapping&& other) noexcept : start_(std::exchange(other.start_, MAP_FAILED)), size_(other.size_) {}
  Mapping& operator=(Mapping&&) = delete;
  ~Mapping() {
    if (mapped()) munmap(start_, size_);
  }

  bool mapped() const { return start_ != MAP_FAILED; }
  std::span<const std::byte> bytes() const { return {static_cast<const std::byte*>(start_), size_}; }

 private:
  void* start_;
  std::size_t size_;
};

Result<std::unique_ptr<V4l2Source>> V4l2Source::open(const std::filesystem::path& node,
                                                     const CameraSettings& settings) {
  auto file = open_alone(node);
  if (!file) return tl::unexpected(file.error());
  v4l2_capability capability{};
  if (ask(file->get(), VIDIOC_QUERYCAP, &capability) < 0)
    return failure(Fault::unsupported, node.string() + " is no camera; name a /dev/video…");
  constexpr std::uint32_t needed = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((capability.device_caps & needed) != needed)
    return failure(Fault::unsupported, node.string() + " gives no pictures; the camera's other node may");
  std::unique_ptr<V4l2Source> source(new V4l2Source(std::move(*file), node, settings));
  if (auto chosen = source->choose_format(); !chosen) return tl::unexpected(chosen.error());
  source->choose_rate();
  source->choose_controls();
  if (auto started = source->start(); !started) return tl::unexpected(started.error());
  return source;
}

V4l2Source::V4l2Source(FileDescriptor file, std::filesystem::path node, CameraSettings settings)
    : file_(std::move(file)), node_(std::move(node)), settings_(std::move(settings)) {}

V4l2Source::~V4l2Source() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  ask(file_.get(), VIDIOC_STREAMOFF, &type);
}

Result<void> V4l2Source::choose_format() {
  const auto tried = settings_.format ? std::vector{*settings_.format}
                                      : std::vector{PixelFormat::mjpeg, PixelFormat::yuyv, PixelFormat::grey};
  for (const PixelFormat wanted : tried) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    format.fmt.pix.width = static_cast<std::uint32_t>(settings_.width);
    format.fmt.pix.height = static_cast<std::uint32_t>(settings_.height);
    format.fmt.pix.pixelformat = code_of(wanted);
    format.fmt.pix.field = V4L2_FIELD_ANY;
    const int status = ask(file_.get(), VIDIOC_S_FMT, &format);
    if (status < 0 && errno == EBUSY)
      return failure(Fault::busy, node_.string() + " is held by another program; end it first");
    if (status < 0 || format.fmt.pix.pixelformat != code_of(wanted)) continue;
    settings_.format = wanted;
    settings_.width = static_cast<std::int32_t>(format.fmt.pix.width);
    settings_.height = static_cast<std::int32_t>(format.fmt.pix.height);
    return {};
  }
  if (settings_.format)
    return failure(Fault::unsupported,
                   node_.string() + " has not this format; try another (yuyv, mjpeg, grey)");
  return failure(Fault::unsupported, node_.string() +
                                         " is a camera without MJPEG, YUYV and GREY pictures, and others "
                                         "are not read here; use another camera");
}

void V4l2Source::choose_rate() {
  constexpr std::uint32_t fine = 1000;
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_fract& period = parameters.parm.capture.timeperframe;
  period = {fine, static_cast<std::uint32_t>(std::lround(settings_.rate_hz * fine))};
  const bool set = ask(file_.get(), VIDIOC_S_PARM, &parameters) == 0 && period.numerator != 0;
  settings_.rate_hz = set ? static_cast<double>(period.denominator) / period.numerator : 0;
}

// Sets `control` within its range once its automatic counterpart is off; none where the camera lacks it.
std::optional<std::int32_t> V4l2Source::hold(std::uint32_t automatic, std::int32_t off, std::uint32_t id,
                                             std::int32_t value) {
  v4l2_control switched{automatic, off};
  ask(file_.get(), VIDIOC_S_CTRL, &switched);
  v4l2_queryctrl range{};
  range.id = id;
  if (ask(file_.get(), VIDIOC_QUERYCTRL, &range) < 0 || (range.flags & V4L2_CTRL_FLAG_DISABLED) != 0)
    return std::nullopt;
  v4l2_control held{id, std::clamp(value, range.minimum, range.maximum)};
  if (ask(file_.get(), VIDIOC_S_CTRL, &held) < 0 || ask(file_.get(), VIDIOC_G_CTRL, &held) < 0)
    return std::nullopt;
  return held.value;
}

void V4l2Source::choose_controls() {
  if (settings_.exposure_s) {
    const auto counts = static_cast<std::int32_t>(std::lround(*settings_.exposure_s / exposure_unit_s));
    const auto held =
        hold(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, V4L2_CID_EXPOSURE_ABSOLUTE, std::max(counts, 1));
    settings_.exposure_s = held ? std::optional(*held * exposure_unit_s) : std::nullopt;
  }
  if (settings_.gain) settings_.gain = hold(V4L2_CID_AUTOGAIN, 0, V4L2_CID_GAIN, *settings_.gain);
  if (settings_.focus)
    settings_.focus = hold(V4L2_CID_FOCUS_AUTO, 0, V4L2_CID_FOCUS_ABSOLUTE, *settings_.focus);
}

Result<void> V4l2Source::start() {
  v4l2_requestbuffers request{};
  request.count = buffer_count;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (ask(file_.get(), VIDIOC_REQBUFS, &request) < 0)
    return failure(errno == EBUSY ? Fault::busy : Fault::unsupported,
                   node_.string() + " does not stream: " + std::strerror(errno));
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = capture_buffer();
    buffer.index = i;
    if (ask(file_.get(), VIDIOC_QUERYBUF, &buffer) == 0) buffers_.emplace_back(file_.get(), buffer);
    if (buffers_.size() <= i || !buffers_.back().mapped() || ask(file_.get(), VIDIOC_QBUF, &buffer) < 0)
      return failure(Fault::unsupported, node_.string() + " lends no buffers: " + std::strerror(errno));
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (ask(file_.get(), VIDIOC_STREAMON, &type) == 0) return {};
  return failure(Fault::unsupported, node_.string() + " does not start: " + std::strerror(errno) +
                                         "; another camera may have taken the bus");
}

Result<std::optional<Transfer>> V4l2Source::read(std::optional<Timestamp> deadline) {
  for (;;) {
    if (auto transfer = inbox_.take()) return transfer;
    if (gone_) return failure(Fault::device_gone, node_.string() + " was unplugged; plug it in again");
    const Inbox::Outcome outcome = inbox_.wait(file_.get(), deadline);
    if (outcome.ready || outcome.gone) take_picture(outcome.gone);
    if (outcome.woken || outcome.late) return inbox_.take();
  }
}

// EIO alone is a picture that came to nothing; from a queue that has failed as a whole it comes for ever.
void V4l2Source::take_picture(bool hung_up) {
  v4l2_buffer buffer = capture_buffer();
  if (ask(file_.get(), VIDIOC_DQBUF, &buffer) < 0) {
    if (errno != EAGAIN && (errno != EIO || hung_up)) unplugged();
    return;
  }
  const bool monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const Timestamp time = monotonic ? Timestamp(std::chrono::seconds(buffer.timestamp.tv_sec) +
                                               std::chrono::microseconds(buffer.timestamp.tv_usec))
                                   : monotonic_now();
  const StampedBy by = monotonic ? StampedBy::kernel : StampedBy::arrival;
  const auto whole = buffers_.at(buffer.index).bytes();
  const auto used = whole.first(std::min<std::size_t>(buffer.bytesused, whole.size()));
  frame_.time = {time, by, buffer.sequence, std::nullopt};
  frame_.moment = moment_of(buffer.flags);
  frame_.format = *settings_.format;
  frame_.width = settings_.width;
  frame_.height = settings_.height;
  frame_.exposure_s = settings_.exposure_s;
  frame_.damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  frame_.after_gap = buffer.sequence != (counted_ ? *counted_ + 1 : 0);
  counted_ = buffer.sequence;
  inbox_.put({time, by, Direction::from_device, TransferKind::picture, {used.begin(), used.end()}});
  ask(file_.get(), VIDIOC_QBUF, &buffer);
}

void V4l2Source::unplugged() {
  gone_ = true;
  inbox_.put({monotonic_now(), StampedBy::arrival, Direction::from_device, TransferKind::unplugged, {}});
}

}  // namespace fude

#include "capture/export/picture_export.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "capture/picture/picture_png.h"
#include "capture/recorded_pictures.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t second = 1'000'000'000;

struct Picture {
  CameraFrame frame;
  const Transfer* transfer = nullptr;
  std::string name;
};

std::int64_t ns_of(const CameraFrame& frame) { return frame.time.host.time_since_epoch().count(); }

std::string name_of(const CameraFrame& frame, int digits) {
  char name[96];
  const auto ns = ns_of(frame);
  std::snprintf(name, sizeof name, "%s%0*lld.%09lld_%06llu.%s", ns < 0 ? "-" : "", digits,
                std::llabs(ns / second), std::llabs(ns % second),
                static_cast<unsigned long long>(frame.time.sequence),
                frame.format == PixelFormat::mjpeg ? "jpg" : "png");
  return name;
}

std::vector<Picture> pictures_of(const Session& session, const SessionStream& stream) {
  std::vector<Picture> pictures;
  RecordedPictures recorded(session, stream.device);
  std::size_t digits = 1;
  for (std::size_t i = 0; i < stream.samples.size(); ++i) {
    const Sample sample = sample_at(session, stream, i);
    const auto* frame = std::get_if<CameraFrame>(&sample);
    if (frame == nullptr) return {};
    pictures.push_back({*frame, recorded.of(*frame), {}});
    digits = std::max(digits, std::to_string(std::llabs(ns_of(*frame) / second)).size());
  }
  for (Picture& picture : pictures) picture.name = name_of(picture.frame, static_cast<int>(digits));
  return pictures;
}

Result<void> write(const fs::path& file, std::span<const std::byte> bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) return {};
  std::error_code ignored;
  fs::remove(file, ignored);
  return failure(Fault::storage, file.string() + " cannot be written; check the folder and the disk");
}

}  // namespace

Result<PicturesWritten> write_pictures(const Session& session, const SessionStream& stream,
                                       const fs::path& folder, bool overwrite,
                                       const std::function<void(double)>& progress) {
  const std::vector<Picture> pictures = pictures_of(session, stream);
  if (pictures.empty())
    return failure(Fault::usage, stream.name + " is no camera; --to csv writes its samples");
  if (std::ranges::none_of(pictures, [](const Picture& p) { return p.transfer != nullptr; }))
    return failure(Fault::not_found,
                   "the session has the times of " + stream.name + " and none of its pictures");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return failure(Fault::no_access, folder.string() + " cannot be made a folder: " + error.message());
  for (const Picture& picture : pictures)
    if (!overwrite && fs::exists(folder / picture.name, error))
      return failure(Fault::exists, (folder / picture.name).string() +
                                        " exists already; choose another folder or give --force");
  PicturesWritten done;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto& [frame, transfer, name] = pictures[i];
    if (transfer == nullptr) {
      ++done.absent;
      continue;
    }
    const bool raw = frame.format == PixelFormat::grey || frame.format == PixelFormat::yuyv;
    Result<void> written;
    if (raw) {
      const auto png = raw_to_png(transfer->payload, frame.format, frame.width, frame.height);
      if (!png) {
        ++done.damaged;
        continue;
      }
      written = write(folder / name, *png);
    } else {
      written = write(folder / name, transfer->payload);
    }
    if (!written) return tl::unexpected(written.error());
    ++done.written;
    progress(static_cast<double>(i + 1) / static_cast<double>(pictures.size()));
  }
  return done;
}

}  // namespace fude

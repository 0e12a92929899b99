#include "rig/calibration/calibration_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "rig/share_folder.h"

namespace fude {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int operator*() const { return number_; }

 private:
  int number_;
};

tl::unexpected<Error> cannot_write(const fs::path& path, int error_number) {
  const bool forbidden = error_number == EACCES || error_number == EPERM || error_number == EROFS;
  return failure(forbidden ? Fault::no_access : Fault::storage,
                 path.string() + " cannot be written: " + std::strerror(error_number) +
                     "; XDG_DATA_HOME chooses another folder");
}

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// What was written into a folder's own list reaches the disk with it.
void settle(const fs::path& folder) {
  const Descriptor list(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (*list >= 0) fsync(*list);
}

// The file appears whole, under a name that was free.
Result<void> write_new(const fs::path& file, std::string_view text) {
  std::string part = (file.parent_path() / ".part-XXXXXX").string();
  const Descriptor out(mkostemp(part.data(), O_CLOEXEC));
  if (*out < 0) return cannot_write(file, errno);
  const bool whole = write_all(*out, text) && fchmod(*out, 0644) == 0 && fsync(*out) == 0 &&
                     link(part.c_str(), file.c_str()) == 0;
  const int error_number = errno;
  unlink(part.c_str());
  if (!whole) return cannot_write(file, error_number);
  settle(file.parent_path());
  return {};
}

// The one writer at a time; let go by the kernel too when a process dies.
Result<std::unique_ptr<Descriptor>> lock(const fs::path& folder) {
  std::error_code wrong;
  fs::create_directories(folder, wrong);
  if (wrong) return cannot_write(folder, wrong.value());
  const fs::path file = folder / ".lock";
  auto held = std::make_unique<Descriptor>(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (**held < 0) return cannot_write(file, errno);
  while (flock(**held, LOCK_EX) != 0)
    if (errno != EINTR) return cannot_write(file, errno);
  return held;
}

// Any word as a part of a file's name, different words as different ones.
std::string as_name(std::string_view word) {
  std::string name;
  for (const char c : word) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == ':' || c == '-' || c == '_' || c == '.';
    char code[4] = {c, 0, 0, 0};
    if (!plain)
      std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    name += code;
  }
  return name;
}

// "0f44:ff20:A1,brush,easel": the devices, the tool and the reference that it was done with.
std::string folder_name(const CalibrationReport& report) {
  std::string name;
  for (const std::string& device : report.devices) name += (name.empty() ? "" : "+") + as_name(device);
  if (!report.tool.empty() || !report.reference.empty()) name += "," + as_name(report.tool);
  if (!report.reference.empty()) name += "," + as_name(report.reference);
  constexpr std::size_t longest = 240;
  if (name.empty()) name = "any";
  return name.substr(0, longest);
}

std::string four_digits(int number) {
  char text[16];
  std::snprintf(text, sizeof text, "%04d", number);
  return text;
}

// A version's name tells what was current before it: "0003-after-0001.toml".
struct Version {
  int number = 0;
  int before = 0;  // 0: none

  std::string name() const {
    return four_digits(number) + (before > 0 ? "-after-" + four_digits(before) : "") + ".toml";
  }
};

std::optional<Version> version_from(std::string_view name) {
  Version version;
  const auto number = [&name](int& into) {
    const auto read = std::from_chars(name.data(), name.data() + name.size(), into);
    name.remove_prefix(static_cast<std::size_t>(read.ptr - name.data()));
    return read.ec == std::errc() && into > 0;
  };
  if (!number(version.number)) return std::nullopt;
  if (constexpr std::string_view after = "-after-"; name.starts_with(after)) {
    name.remove_prefix(after.size());
    if (!number(version.before)) return std::nullopt;
  }
  return name == ".toml" ? std::optional(version) : std::nullopt;
}

std::vector<Version> versions_in(const fs::path& folder) {
  std::vector<Version> versions;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (const auto version = version_from(entry.path().filename().string())) versions.push_back(*version);
  std::ranges::sort(versions, {}, &Version::number);
  return versions;
}

std::optional<Version> current_in(const fs::path& folder) {
  std::error_code none;
  const fs::path target = fs::read_symlink(folder / "current", none);
  return none ? std::nullopt : version_from(target.string());
}

Result<void> make_current(const fs::path& folder, const Version& version) {
  const fs::path part = folder / ".part-current", current = folder / "current";
  unlink(part.c_str());
  if (symlink(version.name().c_str(), part.c_str()) != 0 || rename(part.c_str(), current.c_str()) != 0)
    return cannot_write(current, errno);
  settle(folder);
  return {};
}

std::string described(const CalibrationReport& report) {
  std::string text = report.procedure;
  for (const std::string& device : report.devices) text += " " + device;
  return text + (report.tool.empty() ? "" : " of the tool " + report.tool);
}

}  // namespace

Result<CalibrationStore> CalibrationStore::of_user() {
  const fs::path folder = user_folder();
  if (folder.empty())
    return failure(Fault::not_found, "calibrations are kept nowhere: neither XDG_DATA_HOME nor HOME is set");
  return CalibrationStore(folder / "calibration");
}

Result<KeptCalibration> CalibrationStore::keep(const StoredCalibration& calibration) const {
  const auto locked = lock(folder_);
  if (!locked) return tl::unexpected(locked.error());
  const fs::path folder = folder_ / as_name(calibration.report.procedure) / folder_name(calibration.report);
  std::error_code wrong;
  fs::create_directories(folder, wrong);
  if (wrong) return cannot_write(folder, wrong.value());
  const auto versions = versions_in(folder);
  const auto current = current_in(folder);
  const Version next{versions.empty() ? 1 : versions.back().number + 1, current ? current->number : 0};
  const fs::path file = folder / next.name();
  if (auto written = write_new(file, toml_of(calibration)); !written) return tl::unexpected(written.error());
  if (auto made = make_current(folder, next); !made) return tl::unexpected(made.error());
  return KeptCalibration{file, next.number, true, calibration};
}

std::vector<KeptCalibration> CalibrationStore::all(std::vector<std::string>& warnings) const {
  std::vector<KeptCalibration> kept;
  std::error_code ignored;
  std::vector<fs::path> folders;
  for (const auto& procedure : fs::directory_iterator(folder_, ignored))
    if (procedure.is_directory(ignored))
      for (const auto& devices : fs::directory_iterator(procedure, ignored))
        if (devices.is_directory(ignored)) folders.push_back(devices.path());
  std::ranges::sort(folders);
  for (const fs::path& folder : folders) {
    const auto current = current_in(folder);
    for (const Version& version : versions_in(folder)) {
      const fs::path file = folder / version.name();
      auto calibration = read_calibration(file);
      if (calibration)
        kept.push_back(
            {file, version.number, current && current->number == version.number, std::move(*calibration)});
      else
        warnings.push_back(calibration.error().message);
    }
  }
  return kept;
}

std::vector<KeptCalibration> CalibrationStore::current(std::vector<std::string>& warnings) const {
  std::vector<KeptCalibration> kept = all(warnings);
  std::erase_if(kept, [](const KeptCalibration& k) { return !k.current; });
  return kept;
}

Result<KeptCalibration> CalibrationStore::roll_back(std::string_view procedure, std::string_view device,
                                                    std::string_view tool) const {
  const auto locked = lock(folder_);
  if (!locked) return tl::unexpected(locked.error());
  std::vector<std::string> warnings;
  std::vector<KeptCalibration> fitting = current(warnings);
  std::erase_if(fitting, [&](const KeptCalibration& kept) {
    const CalibrationReport& r = kept.calibration.report;
    return r.procedure != procedure || (!tool.empty() && r.tool != tool) ||
           (!device.empty() && std::ranges::find(r.devices, device) == r.devices.end());
  });
  if (fitting.empty())
    return failure(Fault::not_found,
                   "no " + std::string(procedure) + " of that is kept; `fude calibrate list` tells what is");
  if (fitting.size() > 1)
    return failure(Fault::usage, "several are kept: name one with --device or --tool (" +
                                     described(fitting[0].calibration.report) + ", " +
                                     described(fitting[1].calibration.report) + ")");
  const fs::path folder = fitting.front().file.parent_path();
  const int before = version_from(fitting.front().file.filename().string())->before;
  const auto versions = versions_in(folder);
  const auto earlier = std::ranges::find(versions, before, &Version::number);
  if (before == 0 || earlier == versions.end())
    return failure(Fault::not_found, described(fitting.front().calibration.report) +
                                         " has no version before this one; calibrate again");
  const fs::path file = folder / earlier->name();
  auto calibration = read_calibration(file);
  if (!calibration) return tl::unexpected(calibration.error());
  if (auto made = make_current(folder, *earlier); !made) return tl::unexpected(made.error());
  return KeptCalibration{file, earlier->number, true, std::move(*calibration)};
}

std::vector<StoredCalibration> calibrations_of_user(std::vector<std::string>& warnings) {
  std::vector<StoredCalibration> calibrations;
  const auto store = CalibrationStore::of_user();
  if (!store) return calibrations;
  for (KeptCalibration& kept : store->current(warnings)) calibrations.push_back(std::move(kept.calibration));
  return calibrations;
}

}  // namespace fude

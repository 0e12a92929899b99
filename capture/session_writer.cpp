#include "capture/session_writer.h"

#include <nlohmann/json.hpp>

#include "capture/session_schema.h"
#include "capture/session_words.h"

namespace fude {
namespace {

void bind_optional(Statement& s, const std::optional<double>& value) {
  if (value)
    s.bind(*value);
  else
    s.bind_null();
}

template <class Unit>
std::optional<double> number(const std::optional<Quantity<Unit>>& quantity) {
  return quantity ? std::optional<double>(quantity->value) : std::nullopt;
}

}  // namespace

Result<SessionWriter> SessionWriter::create(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored))
    return failure(Fault::exists, path.string() + " exists already; choose another name or give --force");
  auto db = Database::open(path, OpenMode::create);
  if (!db) return tl::unexpected(db.error());
  // Exclusive locking keeps a second program out; WAL with FULL survives a power cut.
  std::string head =
      "PRAGMA locking_mode=EXCLUSIVE; PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; BEGIN IMMEDIATE;"
      "PRAGMA application_id=" +
      std::to_string(session_schema::application_id) +
      "; PRAGMA user_version=" + std::to_string(session_schema::format) + ";";
  for (const char* table : session_schema::tables) head += std::string(table) + ";";
  head += "INSERT INTO meta VALUES('complete','no'),('written_by','fude 0.1'); COMMIT;";
  if (auto r = db->run(head); !r) return tl::unexpected(r.error());

  const char* texts[] = {
      "INSERT OR REPLACE INTO setting VALUES(?,?)",
      "INSERT OR REPLACE INTO snapshot VALUES(?,?)",
      "INSERT INTO calibration(name,toml) VALUES(?,?)",
      "INSERT INTO device VALUES(NULL,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
      "INSERT OR REPLACE INTO axis VALUES(?,?,?,?,?,?,?,?)",
      "INSERT INTO transfer VALUES(NULL,?,?,?,?,?,?)",
      "INSERT INTO pen_sample VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
      "INSERT INTO action VALUES(?,?,?,?)",
      "INSERT OR REPLACE INTO applied VALUES(?,?)",
      "INSERT OR REPLACE INTO receipt VALUES(?,?,?,?)",
  };
  std::vector<Statement> prepared;
  for (const char* text : texts) {
    auto statement = db->prepare(text);
    if (!statement) return tl::unexpected(statement.error());
    prepared.push_back(std::move(*statement));
  }
  Statements statements{std::move(prepared[0]), std::move(prepared[1]), std::move(prepared[2]),
                        std::move(prepared[3]), std::move(prepared[4]), std::move(prepared[5]),
                        std::move(prepared[6]), std::move(prepared[7]), std::move(prepared[8]),
                        std::move(prepared[9])};
  return SessionWriter(std::move(*db), std::move(statements));
}

Result<void> SessionWriter::write(Statement& statement) {
  if (!in_transaction_) {
    if (auto r = db_.run("BEGIN"); !r) return r;
    in_transaction_ = true;
  }
  if (auto r = statement.step(); !r) return tl::unexpected(r.error());
  return {};
}

Result<void> SessionWriter::set(const std::string& key, const std::string& value) {
  return write(to_.setting.bind(key).bind(value));
}

Result<void> SessionWriter::set_sheet(const RecordedSheet& sheet) {
  return write(to_.sheet.bind(sheet.step).bind(std::span<const std::byte>(sheet.state)));
}

Result<void> SessionWriter::add_calibration(const RecordedCalibration& calibration) {
  return write(to_.calibration.bind(calibration.name).bind(calibration.toml));
}

Result<DeviceNumber> SessionWriter::add_device(const DeviceDescription& d) {
  Statement& s = to_.device;
  s.bind(d.id).bind(d.name).bind(word_for(d.kind)).bind(d.transport);
  for (const std::int64_t v : {d.bus, d.vendor, d.product, d.version}) s.bind(v);
  s.bind(d.serial).bind(nlohmann::json(d.keys).dump()).bind(nlohmann::json(d.properties).dump());
  bind_optional(s, number(d.width));
  bind_optional(s, number(d.height));
  bind_optional(s, d.mm_per_count);
  if (auto r = write(s); !r) return tl::unexpected(r.error());
  const DeviceNumber device = db_.last_row();
  for (const AxisRange& a : d.axes) {
    to_.axis.bind(device);
    for (const std::int64_t v :
         {std::int64_t{a.code}, std::int64_t{a.minimum}, std::int64_t{a.maximum}, std::int64_t{a.fuzz},
          std::int64_t{a.flat}, std::int64_t{a.resolution}, std::int64_t{a.value}})
      to_.axis.bind(v);
    if (auto r = write(to_.axis); !r) return tl::unexpected(r.error());
  }
  return device;
}

Result<void> SessionWriter::add_transfer(DeviceNumber device, const Transfer& t) {
  to_.transfer.bind(device)
      .bind(std::int64_t{t.time.time_since_epoch().count()})
      .bind(word_for(t.stamped_by));
  to_.transfer.bind(word_for(t.direction)).bind(word_for(t.kind)).bind(std::span<const std::byte>(t.payload));
  return write(to_.transfer);
}

Result<InputOrder> SessionWriter::add_pen(DeviceNumber device, const PenSample& p) {
  const InputOrder input = next_input_++;
  Statement& s = to_.pen;
  s.bind(input).bind(device).bind(std::int64_t{p.time.host.time_since_epoch().count()});
  s.bind(word_for(p.time.stamped_by)).bind(static_cast<std::int64_t>(p.time.sequence));
  if (p.time.device_tick)
    s.bind(static_cast<std::int64_t>(*p.time.device_tick));
  else
    s.bind_null();
  s.bind(word_for(p.tool)).bind(static_cast<std::int64_t>(p.tool_serial)).bind(std::int64_t{p.tool_id});
  s.bind(std::int64_t{p.in_proximity}).bind(std::int64_t{p.in_contact}).bind(p.x_counts).bind(p.y_counts);
  s.bind(p.pressure.value).bind(std::int64_t{p.pressure_raw});
  for (const auto& angle : {p.tilt_x, p.tilt_y, p.rotation}) bind_optional(s, number(angle));
  for (const auto& fraction : {p.distance, p.wheel}) bind_optional(s, number(fraction));
  s.bind(std::int64_t{p.buttons}).bind(std::int64_t{p.after_gap});
  if (auto r = write(s); !r) return tl::unexpected(r.error());
  return input;
}

Result<InputOrder> SessionWriter::add_action(const Action& action) {
  const InputOrder input = next_input_++;
  const ActionWords words = words_for(action);
  to_.action.bind(input).bind(std::int64_t{action.time.time_since_epoch().count()});
  if (auto r = write(to_.action.bind(words.verb).bind(words.arguments)); !r) return tl::unexpected(r.error());
  return input;
}

Result<void> SessionWriter::applied(InputOrder input, Step step) {
  return write(to_.applied.bind(input).bind(step));
}

Result<void> SessionWriter::add_receipt(const Receipt& r) {
  return write(to_.receipt.bind(r.device).bind(r.expected).bind(r.received).bind(r.dropped));
}

Result<void> SessionWriter::flush() {
  if (!in_transaction_) return {};
  if (auto r = db_.run("COMMIT"); !r) return r;
  in_transaction_ = false;
  return {};
}

Result<void> SessionWriter::close() {
  if (auto r = flush(); !r) return r;
  return db_.run(
      "UPDATE meta SET value='yes' WHERE key='complete'; PRAGMA wal_checkpoint(TRUNCATE); "
      "PRAGMA journal_mode=DELETE; PRAGMA locking_mode=NORMAL; SELECT count(*) FROM meta;");
}

}  // namespace fude

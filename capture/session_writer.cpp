#include "capture/session_writer.h"

#include <nlohmann/json.hpp>

#include "capture/action_words.h"
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

void bind_cell(Statement& s, const Cell& cell) {
  struct Binder {
    Statement& to;
    void operator()(std::monostate) { to.bind_null(); }
    void operator()(std::int64_t number) { to.bind(number); }
    void operator()(double number) { to.bind(number); }
    void operator()(const std::string& text) { to.bind(std::string_view(text)); }
  };
  std::visit(Binder{s}, cell);
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
  for (const std::string& table : session_schema::tables(session_schema::format)) head += table + ";";
  head += "INSERT INTO meta VALUES('complete','no'),('written_by','fude 0.1'); COMMIT;";
  if (auto r = db->run(head); !r) return tl::unexpected(r.error());

  std::optional<Error> wrong;
  const auto prepare = [&](const std::string& sql) {
    auto statement = db->prepare(sql);
    if (!statement && !wrong) wrong = statement.error();
    return statement ? std::move(*statement) : Statement(nullptr);
  };
  Statements to{.setting = prepare("INSERT OR REPLACE INTO setting VALUES(?,?)"),
                .sheet = prepare("INSERT OR REPLACE INTO snapshot VALUES(?,?)"),
                .calibration = prepare("INSERT INTO calibration(name,toml) VALUES(?,?)"),
                .device = prepare("INSERT INTO device VALUES(NULL,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
                .axis = prepare("INSERT OR REPLACE INTO axis VALUES(?,?,?,?,?,?,?,?)"),
                .transfer = prepare("INSERT INTO transfer VALUES(NULL,?,?,?,?,?,?,?)"),
                .action = prepare("INSERT INTO action VALUES(?,?,?,?)"),
                .applied = prepare("INSERT OR REPLACE INTO applied VALUES(?,?)"),
                .receipt = prepare("INSERT OR REPLACE INTO receipt VALUES(?,?,?,?)"),
                .clock_fit = prepare("INSERT INTO clock_fit VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
                .passed_over = prepare("INSERT INTO passed_over VALUES(?,?,?)"),
                .samples = {}};
  for (const SampleTable& table : sample_tables())
    to.samples.push_back(prepare(session_schema::insert(table)));
  if (wrong) return tl::unexpected(*wrong);
  return SessionWriter(std::move(*db), std::move(to));
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
  if (d.clock)
    s.bind(std::int64_t{d.clock->counter_bits});
  else
    s.bind_null();
  bind_optional(s, d.clock ? d.clock->nominal_tick : std::nullopt);
  s.bind(std::span<const std::byte>(d.hid_descriptor));
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
  return write(to_.transfer.bind(std::int64_t{t.endpoint}));
}

Result<InputOrder> SessionWriter::add_sample(DeviceNumber device, const Sample& sample) {
  const InputOrder input = next_input_++;
  Statement& s = to_.samples[sample.index()];
  s.bind(input).bind(device);
  for (const SampleColumn& column : sample_tables()[sample.index()].columns) bind_cell(s, column.get(sample));
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

Result<void> SessionWriter::add_clock_fit(const RecordedClockFit& fit) {
  const ClockLine& line = fit.line;
  Statement& s = to_.clock_fit;
  s.bind(fit.device).bind(fit.part).bind(static_cast<std::int64_t>(line.first_reading));
  s.bind(std::int64_t{line.since.time_since_epoch().count()})
      .bind(static_cast<std::int64_t>(line.first_tick));
  s.bind(std::int64_t{line.counter_bits}).bind(std::int64_t{line.offset.time_since_epoch().count()});
  s.bind(line.tick_s);
  bind_optional(s, line.nominal_tick);
  bind_optional(s, line.drift_ppm());
  s.bind(static_cast<std::int64_t>(line.readings)).bind(static_cast<std::int64_t>(line.outliers));
  s.bind(line.residual_s.p50).bind(line.residual_s.p99).bind(line.residual_s.largest);
  return write(s);
}

Result<void> SessionWriter::add_passed_over(const PassedOver& passed) {
  return write(to_.passed_over.bind(passed.device).bind(passed.what).bind(passed.count));
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

#include <algorithm>
#include <nlohmann/json.hpp>

#include "capture/action_words.h"
#include "capture/database.h"
#include "capture/sample_columns.h"
#include "capture/session.h"
#include "capture/session_schema.h"
#include "capture/session_words.h"

namespace fude {
namespace {

// Sixteen-bit numbers only: whatever else stands in the list is left out.
std::vector<std::uint16_t> codes_from(const std::string& text) {
  std::vector<std::uint16_t> codes;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_array()) return codes;
  for (const auto& item : json)
    if (item.is_number_unsigned() && item.get<std::uint64_t>() <= 0xffff)
      codes.push_back(item.get<std::uint16_t>());
  return codes;
}

template <class Q>
std::optional<Q> optional_quantity(const Statement& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  return Q(row.real(column));
}

Timestamp time_at(const Statement& row, int column) { return Timestamp(Duration(row.integer(column))); }

int counter_bits(std::int64_t stored) {
  return stored == 8 || stored == 16 || stored == 32 ? static_cast<int>(stored) : 64;
}

// Reads one table, a row at a time.
template <class Row>
Result<void> each(Database& db, std::string_view sql, Row row) {
  auto statement = db.prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  while (true) {
    auto more = statement->step();
    if (!more) return tl::unexpected(more.error());
    if (!*more) return {};
    if (Result<void> r = row(*statement); !r) return r;
  }
}

template <class T>
Result<T> value_at(const Statement& row, int column, const Database& db) {
  const std::string word = row.text(column);
  if (const auto value = value_for<T>(word)) return *value;
  return failure(Fault::malformed, db.path().string() + " holds the unknown word '" + word.substr(0, 40) +
                                       "'; it may come from a newer fude");
}

// The tables must be exactly ours: a session from a stranger cannot bring views, triggers or
// generated columns of its own.
Result<int> check_schema(Database& db) {
  const std::string name = db.path().string();
  int id = 0;
  int format = 0;
  if (auto r = each(db, "PRAGMA application_id",
                    [&](const Statement& s) -> Result<void> {
                      id = static_cast<int>(s.integer(0));
                      return {};
                    });
      !r)
    return tl::unexpected(r.error());
  if (auto r = each(db, "PRAGMA user_version",
                    [&](const Statement& s) -> Result<void> {
                      format = static_cast<int>(s.integer(0));
                      return {};
                    });
      !r)
    return tl::unexpected(r.error());
  if (id != session_schema::application_id)
    return failure(Fault::malformed, name + " is a database but not a session of fude");
  if (format < session_schema::oldest_format || format > session_schema::format)
    return failure(Fault::unsupported, name + " has format " + std::to_string(format) +
                                           ", this fude reads formats up to " +
                                           std::to_string(session_schema::format) + "; use a newer fude");
  const std::vector<std::string> tables = session_schema::tables(format);
  std::size_t found = 0;
  auto r = each(
      db, "SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL", [&](const Statement& s) -> Result<void> {
        for (const std::string& table : tables)
          if (s.text(0) == table) {
            ++found;
            return {};
          }
        return failure(Fault::malformed, name + " has a table that no fude writes; it is not opened");
      });
  if (!r) return tl::unexpected(r.error());
  if (found != tables.size())
    return failure(Fault::malformed, name + " lacks tables of a session; it was cut off before it began");
  return format;
}

Result<void> read_devices(Database& db, int format, Session& session) {
  auto r = each(db, "SELECT * FROM device ORDER BY number", [&](const Statement& s) -> Result<void> {
    const auto kind = value_at<DeviceKind>(s, 3, db);
    if (!kind) return tl::unexpected(kind.error());
    RecordedDevice device;
    device.number = s.integer(0);
    DeviceDescription& d = device.description;
    d.id = s.text(1);
    d.name = s.text(2);
    d.kind = *kind;
    d.transport = s.text(4);
    d.bus = static_cast<std::uint16_t>(s.integer(5));
    d.vendor = static_cast<std::uint16_t>(s.integer(6));
    d.product = static_cast<std::uint16_t>(s.integer(7));
    d.version = static_cast<std::uint16_t>(s.integer(8));
    d.serial = s.text(9);
    d.keys = codes_from(s.text(10));
    d.properties = codes_from(s.text(11));
    d.width = optional_quantity<Millimetres>(s, 12);
    d.height = optional_quantity<Millimetres>(s, 13);
    if (!s.is_null(14)) d.mm_per_count = s.real(14);
    if (format >= 2) {
      if (!s.is_null(15)) {
        DeviceClock& clock = d.clock.emplace();
        clock.counter_bits = counter_bits(s.integer(15));
        if (!s.is_null(16)) clock.nominal_tick = s.real(16);
      }
      d.hid_descriptor = s.blob(17);
    }
    session.devices.push_back(std::move(device));
    return {};
  });
  if (!r) return r;
  return each(db, "SELECT * FROM axis ORDER BY device, code", [&](const Statement& s) -> Result<void> {
    for (RecordedDevice& device : session.devices)
      if (device.number == s.integer(0)) {
        AxisRange a;
        a.code = static_cast<std::uint16_t>(s.integer(1));
        std::int32_t* const fields[] = {&a.minimum, &a.maximum, &a.fuzz, &a.flat, &a.resolution, &a.value};
        for (int i = 0; i < 6; ++i) *fields[i] = static_cast<std::int32_t>(s.integer(i + 2));
        device.description.axes.push_back(a);
      }
    return {};
  });
}

Result<void> read_transfers(Database& db, int format, Session& session) {
  return each(db, "SELECT * FROM transfer ORDER BY number", [&](const Statement& s) -> Result<void> {
    const auto by = value_at<StampedBy>(s, 3, db);
    const auto direction = value_at<Direction>(s, 4, db);
    const auto kind = value_at<TransferKind>(s, 5, db);
    if (!by) return tl::unexpected(by.error());
    if (!direction) return tl::unexpected(direction.error());
    if (!kind) return tl::unexpected(kind.error());
    const auto endpoint = static_cast<std::uint8_t>(format >= 2 ? s.integer(7) : 0);
    session.transfers.push_back({s.integer(1), {time_at(s, 2), *by, *direction, *kind, s.blob(6), endpoint}});
    return {};
  });
}

Cell cell_at(const Statement& row, int column, CellType type) {
  if (row.is_null(column)) return {};
  switch (type) {
    case CellType::integer:
      return row.integer(column);
    case CellType::real:
      return row.real(column);
    default:
      return row.text(column);
  }
}

Result<void> read_samples(Database& db, int format, Session& session) {
  for (const SampleTable& table : sample_tables()) {
    const bool pens = table.stream == "pen";
    if (format < 2 && !pens) continue;
    const std::string sql = pens ? "SELECT p.*, a.step FROM pen_sample p LEFT JOIN applied a USING(input)"
                                 : "SELECT * FROM " + table.name;
    auto r = each(db, sql + " ORDER BY input", [&](const Statement& s) -> Result<void> {
      Sample sample = table.blank;
      int at = 2;
      for (const SampleColumn& column : table.columns) {
        if (column.since_format > format) continue;
        if (const Cell cell = cell_at(s, at++, column.type); !column.set(sample, cell))
          return failure(Fault::malformed,
                         db.path().string() + " holds in " + table.name + "." + column.name +
                             " what cannot stand there; it is damaged or comes from a newer fude");
      }
      if (pens) {
        RecordedPen pen{s.integer(0), s.integer(1), std::get<PenSample>(std::move(sample)), std::nullopt};
        if (!s.is_null(at)) pen.applied = s.integer(at);
        session.pens.push_back(std::move(pen));
      } else {
        session.samples.push_back({s.integer(1), std::move(sample), s.integer(0)});
      }
      return {};
    });
    if (!r) return r;
  }
  std::stable_sort(session.samples.begin(), session.samples.end(),
                   [](const RecordedSample& a, const RecordedSample& b) { return a.order < b.order; });
  return {};
}

Result<void> read_actions(Database& db, int, Session& session) {
  return each(db, "SELECT x.*, a.step FROM action x LEFT JOIN applied a USING(input) ORDER BY input",
              [&](const Statement& s) -> Result<void> {
                auto action = action_from(time_at(s, 1), s.text(2), s.text(3));
                if (!action) return tl::unexpected(action.error());
                RecordedAction recorded{s.integer(0), std::move(*action), std::nullopt};
                if (!s.is_null(4)) recorded.applied = s.integer(4);
                session.actions.push_back(std::move(recorded));
                return {};
              });
}

Result<void> read_clock_fits(Database& db, int format, Session& session) {
  if (format < 2) return {};
  auto r = each(db, "SELECT * FROM clock_fit ORDER BY device, part, first_reading",
                [&](const Statement& s) -> Result<void> {
                  ClockLine line;
                  line.first_reading = static_cast<std::size_t>(s.integer(2));
                  line.since = time_at(s, 3);
                  line.first_tick = static_cast<std::uint64_t>(s.integer(4));
                  line.counter_bits = counter_bits(s.integer(5));
                  line.offset = time_at(s, 6);
                  line.tick_s = s.real(7);
                  if (!s.is_null(8)) line.nominal_tick = s.real(8);
                  line.readings = static_cast<std::uint64_t>(s.integer(10));
                  line.outliers = static_cast<std::uint64_t>(s.integer(11));
                  line.residual_s = {s.real(12), s.real(13), s.real(14)};
                  session.clock_fits.push_back({s.integer(0), s.text(1), line});
                  return {};
                });
  if (!r) return r;
  return each(db, "SELECT * FROM passed_over ORDER BY rowid", [&](const Statement& s) -> Result<void> {
    session.passed_over.push_back({s.integer(0), s.text(1), s.integer(2)});
    return {};
  });
}

Result<void> read_remarks(Database& db, int, Session& session) {
  auto r = each(db, "SELECT * FROM setting ORDER BY key", [&](const Statement& s) -> Result<void> {
    session.settings[s.text(0)] = s.text(1);
    return {};
  });
  if (!r) return r;
  r = each(db, "SELECT name, toml FROM calibration ORDER BY number", [&](const Statement& s) -> Result<void> {
    session.calibrations.push_back({s.text(0), s.text(1)});
    return {};
  });
  if (!r) return r;
  r = each(db, "SELECT * FROM receipt ORDER BY device", [&](const Statement& s) -> Result<void> {
    session.receipts.push_back({s.integer(0), s.integer(1), s.integer(2), s.integer(3)});
    return {};
  });
  if (!r) return r;
  r = each(db, "SELECT * FROM snapshot ORDER BY step LIMIT 1", [&](const Statement& s) -> Result<void> {
    session.sheet = RecordedSheet{s.integer(0), s.blob(1)};
    return {};
  });
  if (!r) return r;
  return each(db, "SELECT value FROM meta WHERE key='complete'", [&](const Statement& s) -> Result<void> {
    session.complete = s.text(0) == "yes";
    return {};
  });
}

}  // namespace

Result<Session> read_session(const std::filesystem::path& path) {
  auto db = Database::open(path, OpenMode::read);
  if (!db) return tl::unexpected(db.error());
  Session session;
  const auto format = check_schema(*db);
  if (!format) return tl::unexpected(format.error());
  for (auto* read :
       {read_devices, read_transfers, read_samples, read_actions, read_clock_fits, read_remarks}) {
    if (auto r = read(*db, *format, session); !r) return tl::unexpected(r.error());
  }
  return session;
}

}  // namespace fude

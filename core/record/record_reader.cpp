#include "core/record/record_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "hal/json/json_access.hpp"
#include "hal/scalar_name.hpp"

namespace tandem::core {
namespace {

using hal::Json;

constexpr std::size_t kMostCount = std::size_t{1} << 20;

template <class T>
T read_at(const char* at) noexcept {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

std::string RecordStream::title() const {
  const std::string text = set == "pose" ? name : set + " " + name;
  return of == "robot" ? text : of + " " + text;
}

std::size_t RecordRows::used(std::size_t field, std::size_t row) const noexcept {
  if (starts_[field].empty()) return stream_->fields[field].count;
  return starts_[field][row + 1] - starts_[field][row];
}

double RecordRows::value(std::size_t field, std::size_t row, std::size_t index) const noexcept {
  const RecordField& f = stream_->fields[field];
  const std::size_t number = (starts_[field].empty() ? row * f.count : starts_[field][row]) + index;
  const char* const at = data_.data() + at_[field] + number * hal::size_of(f.scalar);
  switch (f.scalar) {
    case hal::Scalar::F32:
      return static_cast<double>(read_at<float>(at)) * f.scale;
    case hal::Scalar::F64:
      return read_at<double>(at) * f.scale;
    case hal::Scalar::U8:
    case hal::Scalar::Bool:
      return static_cast<double>(read_at<std::uint8_t>(at)) * f.scale;
    case hal::Scalar::U16:
      return static_cast<double>(read_at<std::uint16_t>(at)) * f.scale;
    case hal::Scalar::U32:
      return static_cast<double>(read_at<std::uint32_t>(at)) * f.scale;
    case hal::Scalar::I32: {
      const auto raw = read_at<std::int32_t>(at);
      const bool none = raw == std::numeric_limits<std::int32_t>::min() && f.scale != 1.0;
      return none ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(raw) * f.scale;
    }
    case hal::Scalar::I64:
      return static_cast<double>(read_at<std::int64_t>(at)) * f.scale;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string_view RecordRows::bytes(std::size_t field, std::size_t row) const noexcept {
  const RecordField& f = stream_->fields[field];
  const std::size_t number = starts_[field].empty() ? row * f.count : starts_[field][row];
  const std::size_t size = hal::size_of(f.scalar);
  return data_.substr(at_[field] + number * size, used(field, row) * size);
}

hal::Result<RecordReader> RecordReader::open(const std::string& path) {
  auto file = BlockFileReader::open(path);
  if (!file.ok()) return file.error();
  RecordReader reader(std::move(file).value());
  const std::optional<Block> first = reader.file_.next();
  if (!first || first->type != static_cast<std::uint16_t>(RecordBlock::Start))
    return hal::Error{"record '" + path +
                      "': its beginning is damaged or missing, so nothing says what the rest means"};
  auto start = hal::parse_json_object(first->payload);
  if (!start.ok()) return hal::Error{"record '" + path + "': its beginning makes no sense: " + start.error().message};
  reader.start_ = std::move(start).value();
  const std::size_t behind = reader.file_.at();
  reader.find_blocks();
  reader.file_.go_to(behind);
  return reader;
}

// --- where everything is ---

void RecordReader::find_blocks() {
  bool ended = false;
  std::optional<hal::Tick> tick;
  std::size_t first_of_tick = 0;
  while (const std::optional<Block> block = file_.next_unchecked()) {
    if (block->tick != tick) {
      tick = block->tick;
      first_of_tick = block->at;
    }
    switch (static_cast<RecordBlock>(block->type)) {
      case RecordBlock::Stream:
      case RecordBlock::Members: {
        const std::size_t behind = file_.at();
        file_.go_to(block->at);
        if (const std::optional<Block> checked = file_.next(); checked && checked->at == block->at) {
          if (const hal::Status declared = decoder_.declare(*checked); !declared.ok())
            complain(*checked, declared.error().message);
        }
        file_.go_to(behind);
        break;
      }
      case RecordBlock::Rows: {
        const auto stream = decoder_.stream_of(block->payload);
        if (stream == nullptr) break;
        if (stream->on_change)
          standing_[(std::uint64_t{block->type} << 32) | read_at<std::uint32_t>(block->payload.data())].push_back(
              block->at);
        if (stream->title() != "pose" || (!ticks_.empty() && ticks_.back() >= *tick)) break;
        ticks_.push_back(*tick);
        places_.push_back(first_of_tick);
        break;
      }
      case RecordBlock::Scene:
      case RecordBlock::Floor:
      case RecordBlock::Sketch:
        standing_[std::uint64_t{block->type} << 32].push_back(block->at);
        break;
      case RecordBlock::Event:
        event_places_.push_back(block->at);
        break;
      case RecordBlock::Back:
        leave_branch(block->tick, block->at);
        first_of_tick = block->at;
        break;
      case RecordBlock::End:
        ended = true;
        break;
      default:
        break;
    }
  }
  cut_ = file_.cut() || !ended;
}

/// The run went back to where `to` ticks were done; `at` is the block that says so.
void RecordReader::leave_branch(std::int64_t to, std::size_t at) {
  const auto first = std::lower_bound(ticks_.begin(), ticks_.end(), to);
  if (first == ticks_.end()) return;
  const std::size_t begin = places_[static_cast<std::size_t>(first - ticks_.begin())];
  places_.resize(static_cast<std::size_t>(first - ticks_.begin()));
  ticks_.erase(first, ticks_.end());
  while (!left_.empty() && left_.back().begin >= begin) left_.pop_back();
  left_.push_back({begin, at});
}

void RecordReader::go_to(std::size_t i) noexcept {
  if (i >= places_.size()) return;
  file_.go_to(places_[i]);
  inputs_.lose();
  pending_.clear();
}

std::vector<RecordEntry> RecordReader::standing(std::size_t i) {
  std::vector<RecordEntry> entries;
  if (i >= places_.size()) return entries;
  const std::size_t here = file_.at();
  for (const auto& [what, places] : standing_) {
    auto last = std::lower_bound(places.begin(), places.end(), places_[i]);
    while (last != places.begin()) {  // one that is damaged said nothing
      file_.go_to(*--last);
      const std::optional<Block> block = file_.next();
      auto entry = block && block->at == *last ? entry_of(*block) : std::nullopt;
      if (!entry) continue;
      entries.push_back(std::move(*entry));
      break;
    }
  }
  file_.go_to(here);
  return entries;
}

const std::vector<RecordEvent>& RecordReader::events() {
  if (events_) return *events_;
  events_.emplace();
  const std::size_t here = file_.at();
  for (const std::size_t at : event_places_) {
    file_.go_to(at);
    const std::optional<Block> block = file_.next();
    if (!block || block->at != at) continue;
    if (auto entry = entry_of(*block)) events_->push_back({entry->tick, std::move(entry->json)});
  }
  file_.go_to(here);
  return *events_;
}

// --- what blocks say ---

void RecordReader::complain(const Block& block, const std::string& why) {
  senseless_.emplace(block.at, "tick " + std::to_string(block.tick) + ": " + why);
}

std::optional<RecordEntry> RecordReader::entry_of(const Block& block) {
  auto entry = decoder_.read(block);
  if (entry.ok()) return std::move(entry).value();
  complain(block, entry.error().message);
  return {};
}

hal::Status RecordDecoder::declare(const Block& block) {
  const auto json = hal::parse_json_object(block.payload);
  if (!json.ok()) return json.error();
  return static_cast<RecordBlock>(block.type) == RecordBlock::Stream ? declare_stream(json.value())
                                                                     : declare_members(json.value());
}

std::shared_ptr<const RecordStream> RecordDecoder::stream_of(std::string_view rows) const {
  if (rows.size() < sizeof(std::uint32_t)) return nullptr;
  const auto stream = streams_.find(read_at<std::uint32_t>(rows.data()));
  return stream == streams_.end() ? nullptr : stream->second;
}

hal::Status RecordDecoder::declare_stream(const Json& json) {
  auto stream = std::make_shared<RecordStream>();
  const auto number = hal::count_of(json, "stream");
  stream->of = hal::text_of(json, "of");
  stream->set = hal::text_of(json, "set");
  stream->name = hal::text_of(json, "name");
  stream->on_change = hal::flag_of(json, "on_change");
  const Json* const fields = hal::member_of(json, "fields");
  if (number == 0 || fields == nullptr || !fields->is_array()) return hal::Error{"a stream without number or fields"};
  for (const Json& f : *fields) {
    const auto scalar = hal::scalar_from(hal::text_of(f, "type"));
    const auto count = hal::count_of(f, "count", 1);
    if (!scalar || count > kMostCount) return hal::Error{"a field of stream '" + stream->name + "' has no known type"};
    RecordField field;
    field.name = hal::text_of(f, "name");
    field.unit = hal::text_of(f, "unit");
    field.doc = hal::text_of(f, "doc");
    field.scalar = *scalar;
    field.count = count;
    field.scale = hal::number_of(f, "scale", 1.0);
    field.per_entry = std::min<std::uint64_t>(hal::count_of(f, "per_entry", 1), kMostCount);
    field.texts = hal::texts_of(f, "texts");
    stream->fields.push_back(std::move(field));
  }
  for (std::size_t i = 0; i < stream->fields.size(); ++i) {
    const auto by = hal::text_of((*fields)[i], "used_by");
    if (by.empty()) continue;
    for (std::size_t k = 0; k < stream->fields.size(); ++k) {
      if (stream->fields[k].name == by && stream->fields[k].count == 1) stream->fields[i].used_by = k;
    }
    const auto own = hal::text_of((*fields)[stream->fields[i].used_by.value_or(i)], "used_by");
    if (!stream->fields[i].used_by || !own.empty())
      return hal::Error{"field '" + stream->fields[i].name + "' of stream '" + stream->name + "' counts by none"};
  }
  streams_[number] = std::move(stream);
  return {};
}

hal::Status RecordDecoder::declare_members(const Json& json) {
  auto members = std::make_shared<RecordMembers>();
  const auto number = hal::count_of(json, "members");
  if (number == 0) return hal::Error{"members without a number"};
  members->ids = hal::texts_of(json, "ids");
  members->kinds.resize(members->ids.size());
  members->real.resize(members->ids.size(), false);
  members->kind.resize(members->ids.size(), 0);
  if (const Json& bodies = hal::list_of(json, "bodies"); !bodies.empty()) members->bodies = bodies;
  const std::vector<std::string> kinds = hal::texts_of(json, "kinds");
  const Json& kind = hal::list_of(json, "kind");
  for (std::size_t i = 0; i < std::min(kind.size(), members->kinds.size()); ++i) {
    const Json& k = kind[i];
    if (!k.is_number_unsigned() || k.get<std::uint64_t>() >= kinds.size()) continue;
    members->kind[i] = k.get<std::uint64_t>();
    members->kinds[i] = kinds[members->kind[i]];
  }
  for (const Json& i : hal::list_of(json, "real")) {
    if (i.is_number_unsigned() && i.get<std::uint64_t>() < members->real.size())
      members->real[i.get<std::uint64_t>()] = true;
  }
  const std::size_t count = members->ids.size();
  members->order.resize(count);
  std::iota(members->order.begin(), members->order.end(), std::size_t{0});
  if (const Json& order = hal::list_of(json, "order"); order.size() == count) {
    std::vector<std::size_t> all;
    for (const Json& i : order) all.push_back(i.is_number_unsigned() ? i.get<std::size_t>() : count);
    std::vector<bool> seen(count, false);
    const bool whole = std::all_of(all.begin(), all.end(), [&](std::size_t i) {
      const bool fresh = i < count && !seen[i];
      if (fresh) seen[i] = true;
      return fresh;
    });
    if (whole) members->order = std::move(all);
  }
  members_[number] = std::move(members);
  return {};
}

hal::Result<RecordRows> RecordDecoder::rows(std::string_view payload) const {
  constexpr std::size_t kNumbers = 16;
  if (payload.size() < kNumbers) return hal::Error{"rows without a beginning"};
  auto rows =
      this->rows(read_at<std::uint32_t>(payload.data()), read_at<std::uint32_t>(payload.data() + 4), payload, kNumbers);
  if (rows.ok() && read_at<std::uint32_t>(payload.data() + 8) != rows.value().size())
    return hal::Error{"as many rows as there are no members"};
  return rows;
}

hal::Result<RecordRows> RecordDecoder::input_rows(const InputDecoder::Table& table) const {
  auto rows = this->rows(table.stream, table.members, *table.rows, 0);
  if (rows.ok()) rows.value().own_ = table.rows;
  return rows;
}

/// Of data whose rows begin at `at`.
hal::Result<RecordRows> RecordDecoder::rows(std::uint32_t stream_number, std::uint32_t members_number,
                                            std::string_view payload, std::size_t at) const {
  const auto stream = streams_.find(stream_number);
  const auto members = members_.find(members_number);
  if (stream == streams_.end() || members == members_.end())
    return hal::Error{"rows of a stream that was not declared"};
  RecordRows rows;
  rows.stream_ = stream->second;
  rows.members_ = members->second;
  rows.data_ = payload;
  const std::size_t n = rows.size();
  const std::vector<RecordField>& fields = rows.stream_->fields;
  rows.at_.resize(fields.size());
  rows.starts_.resize(fields.size());
  // The field that counts comes before those that it counts for.
  const auto advance = [&](std::size_t values, std::size_t size) {
    if (values > (payload.size() - at) / size) return false;
    at += values * size;
    return true;
  };
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const RecordField& field = fields[f];
    const std::size_t size = hal::size_of(field.scalar);
    rows.at_[f] = at;
    std::size_t values = n * field.count;
    if (field.used_by) {
      if (*field.used_by >= f)
        return hal::Error{"stream '" + rows.stream_->name + "' counts a field before it is there"};
      std::vector<std::size_t> starts(n + 1, 0);
      for (std::size_t row = 0; row < n; ++row) {
        const double entries = rows.value(*field.used_by, row);
        const double used =
            entries >= 0.0 ? std::min(entries * static_cast<double>(field.per_entry), static_cast<double>(field.count))
                           : 0.0;
        starts[row + 1] = starts[row] + static_cast<std::size_t>(used);
      }
      values = starts[n];
      rows.starts_[f] = std::move(starts);
    }
    if (!advance(values, size)) return hal::Error{"rows of stream '" + rows.stream_->name + "' are too short"};
  }
  if (at != payload.size()) return hal::Error{"rows of stream '" + rows.stream_->name + "' are too long"};
  return rows;
}

hal::Result<std::optional<RecordEntry>> RecordDecoder::read(const Block& block) const {
  RecordEntry entry;
  entry.type = static_cast<RecordBlock>(block.type);
  entry.tick = block.tick;
  switch (entry.type) {
    case RecordBlock::Rows: {
      auto rows = this->rows(block.payload);
      if (!rows.ok()) return rows.error();
      entry.rows = std::move(rows).value();
      return std::optional(std::move(entry));
    }
    case RecordBlock::Fingerprint:
      if (block.payload.size() != sizeof entry.fingerprint) return hal::Error{"a fingerprint of another size"};
      entry.fingerprint = read_at<std::uint64_t>(block.payload.data());
      return std::optional(std::move(entry));
    case RecordBlock::Floor:
    case RecordBlock::Checks:
      entry.bytes = block.payload;
      return std::optional(std::move(entry));
    case RecordBlock::Back:
      return std::optional(std::move(entry));
    case RecordBlock::Start:
    case RecordBlock::Scene:
    case RecordBlock::Event:
    case RecordBlock::Sketch:
    case RecordBlock::End: {
      auto json = hal::parse_json_object(block.payload);
      if (!json.ok()) return json.error();
      entry.json = std::move(json).value();
      return std::optional(std::move(entry));
    }
    default:
      return std::optional<RecordEntry>();  // a declaration, which has been taken, or something of a later release
  }
}

bool RecordReader::left(std::size_t at) const noexcept {
  const auto behind = std::upper_bound(left_.begin(), left_.end(), at,
                                       [](std::size_t place, const Range& range) { return place < range.begin; });
  return behind != left_.begin() && at < (behind - 1)->end;
}

/// One entry for each of its tables.
void RecordReader::take_inputs(const Block& block) {
  if (const hal::Status decoded = inputs_.decode(block.tick, block.payload); !decoded.ok())
    return complain(block, decoded.error().message);
  if (!inputs_.known()) return;  // they build on what was not read
  for (const auto& [stream, table] : inputs_.tables()) {
    auto rows = decoder_.input_rows(table);
    if (!rows.ok()) {
      complain(block, rows.error().message);
      continue;
    }
    RecordEntry entry;
    entry.type = RecordBlock::Inputs;
    entry.tick = block.tick;
    entry.rows = std::move(rows).value();
    pending_.push_back(std::move(entry));
  }
}

std::optional<RecordEntry> RecordReader::next() {
  if (!pending_.empty()) {
    std::optional<RecordEntry> entry(std::move(pending_.front()));
    pending_.pop_front();
    return entry;
  }
  while (const std::optional<Block> header = file_.next_unchecked()) {
    if (left(header->at) && header->type != static_cast<std::uint16_t>(RecordBlock::Event)) continue;
    file_.go_to(header->at);
    const std::optional<Block> block = file_.next();
    if (!block) return {};
    if (left(block->at) && block->type != static_cast<std::uint16_t>(RecordBlock::Event)) continue;  // after damage
    if (block->type == static_cast<std::uint16_t>(RecordBlock::Inputs)) {
      take_inputs(*block);
      if (!pending_.empty()) return next();
      continue;
    }
    if (auto entry = entry_of(*block)) return entry;
  }
  return {};
}

std::vector<std::string> RecordReader::damage() const {
  std::vector<std::string> all = file_.damage();
  for (const auto& [at, line] : senseless_) all.push_back(line);
  return all;
}

}  // namespace tandem::core

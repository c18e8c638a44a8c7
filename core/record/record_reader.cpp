#include "core/record/record_reader.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace tandem::core {
namespace {

using hal::Json;

constexpr std::size_t kMostCount = std::size_t{1} << 20;

std::optional<hal::Scalar> scalar_of(std::string_view type) noexcept {
  for (const auto& [name, scalar] :
       {std::pair{"f32", hal::Scalar::F32}, std::pair{"f64", hal::Scalar::F64}, std::pair{"u8", hal::Scalar::U8},
        std::pair{"u16", hal::Scalar::U16}, std::pair{"u32", hal::Scalar::U32}, std::pair{"i32", hal::Scalar::I32},
        std::pair{"i64", hal::Scalar::I64}, std::pair{"bool", hal::Scalar::Bool}}) {
    if (type == name) return scalar;
  }
  return {};
}

/// The member as a `T`, or `otherwise` where it is missing or something else.
template <class T>
T get(const Json& json, const char* key, T otherwise) {
  const auto found = json.find(key);
  if (found == json.end()) return otherwise;
  if constexpr (std::is_same_v<T, std::string>) {
    return found->is_string() ? found->template get<std::string>() : otherwise;
  } else if constexpr (std::is_same_v<T, double>) {
    return found->is_number() ? found->template get<double>() : otherwise;
  } else {
    return found->is_number_unsigned() ? found->template get<T>() : otherwise;
  }
}

std::vector<std::string> texts_of(const Json& json, const char* key) {
  std::vector<std::string> texts;
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array()) return texts;
  for (const Json& text : *found) texts.push_back(text.is_string() ? text.get<std::string>() : std::string());
  return texts;
}

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
  return reader;
}

hal::Status RecordReader::declare_stream(const Json& json) {
  auto stream = std::make_shared<RecordStream>();
  const auto number = get<std::uint64_t>(json, "stream", 0);
  stream->of = get<std::string>(json, "of", "");
  stream->set = get<std::string>(json, "set", "");
  stream->name = get<std::string>(json, "name", "");
  const auto fields = json.find("fields");
  if (number == 0 || fields == json.end() || !fields->is_array())
    return hal::Error{"a stream without number or fields"};
  for (const Json& f : *fields) {
    const auto scalar = f.is_object() ? scalar_of(get<std::string>(f, "type", "")) : std::nullopt;
    const auto count = f.is_object() ? get<std::uint64_t>(f, "count", 1) : 0;
    if (!scalar || count > kMostCount) return hal::Error{"a field of stream '" + stream->name + "' has no known type"};
    RecordField field;
    field.name = get<std::string>(f, "name", "");
    field.unit = get<std::string>(f, "unit", "");
    field.doc = get<std::string>(f, "doc", "");
    field.scalar = *scalar;
    field.count = count;
    field.scale = get<double>(f, "scale", 1.0);
    field.per_entry = std::min<std::uint64_t>(get<std::uint64_t>(f, "per_entry", 1), kMostCount);
    field.texts = texts_of(f, "texts");
    stream->fields.push_back(std::move(field));
  }
  for (std::size_t i = 0; i < stream->fields.size(); ++i) {
    const auto by = get<std::string>((*fields)[i], "used_by", "");
    if (by.empty()) continue;
    for (std::size_t k = 0; k < stream->fields.size(); ++k) {
      if (stream->fields[k].name == by && stream->fields[k].count == 1) stream->fields[i].used_by = k;
    }
    const auto own = get<std::string>((*fields)[stream->fields[i].used_by.value_or(i)], "used_by", "");
    if (!stream->fields[i].used_by || !own.empty())
      return hal::Error{"field '" + stream->fields[i].name + "' of stream '" + stream->name + "' counts by none"};
  }
  streams_[number] = std::move(stream);
  return {};
}

hal::Status RecordReader::declare_members(const Json& json) {
  auto members = std::make_shared<RecordMembers>();
  const auto number = get<std::uint64_t>(json, "members", 0);
  if (number == 0) return hal::Error{"members without a number"};
  members->ids = texts_of(json, "ids");
  members->kinds.resize(members->ids.size());
  members->real.resize(members->ids.size(), false);
  members->kind.resize(members->ids.size(), 0);
  if (const auto bodies = json.find("bodies"); bodies != json.end() && bodies->is_array()) members->bodies = *bodies;
  const std::vector<std::string> kinds = texts_of(json, "kinds");
  if (const auto kind = json.find("kind"); kind != json.end() && kind->is_array()) {
    for (std::size_t i = 0; i < std::min(kind->size(), members->kinds.size()); ++i) {
      const Json& k = (*kind)[i];
      if (!k.is_number_unsigned() || k.get<std::uint64_t>() >= kinds.size()) continue;
      members->kind[i] = k.get<std::uint64_t>();
      members->kinds[i] = kinds[members->kind[i]];
    }
  }
  if (const auto real = json.find("real"); real != json.end() && real->is_array()) {
    for (const Json& i : *real) {
      if (i.is_number_unsigned() && i.get<std::uint64_t>() < members->real.size())
        members->real[i.get<std::uint64_t>()] = true;
    }
  }
  members_[number] = std::move(members);
  return {};
}

hal::Result<RecordRows> RecordReader::rows(std::string_view payload) const {
  constexpr std::size_t kNumbers = 16;
  if (payload.size() < kNumbers) return hal::Error{"rows without a beginning"};
  const auto stream = streams_.find(read_at<std::uint32_t>(payload.data()));
  const auto members = members_.find(read_at<std::uint32_t>(payload.data() + 4));
  if (stream == streams_.end() || members == members_.end())
    return hal::Error{"rows of a stream that was not declared"};
  RecordRows rows;
  rows.stream_ = stream->second;
  rows.members_ = members->second;
  rows.data_ = payload;
  const std::size_t n = rows.size();
  if (read_at<std::uint32_t>(payload.data() + 8) != n) return hal::Error{"as many rows as there are no members"};
  const std::vector<RecordField>& fields = rows.stream_->fields;
  rows.at_.resize(fields.size());
  rows.starts_.resize(fields.size());
  // The field that counts comes before those that it counts for.
  std::size_t at = kNumbers;
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

std::optional<RecordEntry> RecordReader::next() {
  while (const std::optional<Block> block = file_.next()) {
    const auto type = static_cast<RecordBlock>(block->type);
    const auto complain = [&](const std::string& why) {
      senseless_.push_back("tick " + std::to_string(block->tick) + ": " + why);
    };
    RecordEntry entry;
    entry.type = type;
    entry.tick = block->tick;
    if (type == RecordBlock::Rows) {
      auto rows = this->rows(block->payload);
      if (!rows.ok()) {
        complain(rows.error().message);
        continue;
      }
      entry.rows = std::move(rows).value();
      return entry;
    }
    if (type == RecordBlock::Fingerprint) {
      if (block->payload.size() != sizeof entry.fingerprint) {
        complain("a fingerprint of another size");
        continue;
      }
      entry.fingerprint = read_at<std::uint64_t>(block->payload.data());
      return entry;
    }
    if (type < RecordBlock::Start || type > RecordBlock::End) continue;  // of a later release
    auto json = hal::parse_json_object(block->payload);
    if (!json.ok()) {
      complain(json.error().message);
      continue;
    }
    if (type == RecordBlock::Stream || type == RecordBlock::Members) {
      const hal::Status declared =
          type == RecordBlock::Stream ? declare_stream(json.value()) : declare_members(json.value());
      if (!declared.ok()) complain(declared.error().message);
      continue;
    }
    ended_ = ended_ || type == RecordBlock::End;
    entry.json = std::move(json).value();
    return entry;
  }
  cut_ = file_.cut() || !ended_;
  return {};
}

std::vector<std::string> RecordReader::damage() const {
  std::vector<std::string> all = file_.damage();
  all.insert(all.end(), senseless_.begin(), senseless_.end());
  return all;
}

}  // namespace tandem::core

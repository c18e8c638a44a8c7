#include "core/record/record_moments.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "hal/json/json_access.hpp"

namespace tandem::core {
namespace {

bool has_whole_poses(const RecordRows& rows) noexcept {
  for (const char* const name : {"x", "y", "z", "heading"}) {
    if (!field_of(rows, name)) return false;
  }
  return true;
}

}  // namespace

std::optional<std::size_t> field_of(const RecordRows& rows, std::string_view name) noexcept {
  const std::vector<RecordField>& fields = rows.stream().fields;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].name == name && !fields[f].used_by && fields[f].count > 0) return f;
  }
  return {};
}

RecordMoments::RecordMoments(RecordReader reader) : reader_(std::move(reader)) {
  ticks_per_second_ = std::llround(std::clamp(hal::number_of(reader_.start(), "ticks_per_second", 10.0), 1.0, 1e6));
}

hal::Result<RecordMoments> RecordMoments::open(const std::string& path) {
  auto reader = RecordReader::open(path);
  if (!reader.ok()) return reader.error();
  RecordMoments moments(std::move(reader).value());
  for (std::size_t i = 0; i < moments.ticks().size(); ++i) {
    if (!moments.stand_at(i)) continue;  // damaged
    moments.first_ = i;
    return moments;
  }
  return hal::Error{"record '" + path + "' holds no poses of robots"};
}

const RecordRows* RecordMoments::rows(std::string_view title, std::size_t group) const noexcept {
  auto [found, past] = rows_.equal_range(title);
  for (; found != past && group > 0; --group) ++found;
  return found == past ? nullptr : &found->second;
}

void RecordMoments::take(RecordEntry entry) {
  switch (entry.type) {
    case RecordBlock::Rows: {
      std::string title = entry.rows->stream().title();
      const bool poses = entry.rows->stream().set == "pose" && entry.rows->stream().name == "pose";
      if (poses && !has_whole_poses(*entry.rows)) return;
      const bool all = poses || entry.rows->stream().on_change;  // what holds until there is other
      for (auto [at, past] = rows_.equal_range(title); at != past;)
        at = all || &at->second.members() == &entry.rows->members() ? rows_.erase(at) : std::next(at);
      rows_.emplace(std::move(title), std::move(*entry.rows));
      return;
    }
    case RecordBlock::Scene:
      scene_ = std::move(entry.json);
      ++scene_number_;
      return;
    case RecordBlock::Floor:
      floor_ = entry.bytes;
      ++floor_number_;
      return;
    case RecordBlock::Sketch:
      sketch_ = std::move(entry.json);
      ++sketch_number_;
      return;
    default:
      return;
  }
}

/// Takes all of the tick that the reader stands before; false: poses are missing in it.
bool RecordMoments::read_tick() {
  tick_ = ticks()[at_];
  const std::optional<hal::Tick> later = at_ + 1 < ticks().size() ? std::optional(ticks()[at_ + 1]) : std::nullopt;
  bool found = false;
  for (;;) {
    std::optional<RecordEntry> entry = std::exchange(ahead_, std::nullopt);
    if (!entry) entry = reader_.next();
    if (!entry) return found;
    if (later && entry->tick >= *later) {
      ahead_ = std::move(entry);
      return found;
    }
    if (entry->tick > tick_) continue;  // inputs and events between two ticks that have poses
    found = found || (entry->rows && entry->rows->stream().title() == "pose" && has_whole_poses(*entry->rows));
    take(std::move(*entry));
  }
}

void RecordMoments::go_to(hal::Tick tick) {
  const auto behind = std::upper_bound(ticks().begin(), ticks().end(), tick);
  std::size_t i = behind == ticks().begin() ? 0 : static_cast<std::size_t>(behind - ticks().begin()) - 1;
  if (ticks().empty() || (ticks()[i] == tick_ && rows("pose") != nullptr)) return;
  for (i = std::max(i, first_); !stand_at(i) && i > first_;) --i;
}

bool RecordMoments::stand_at(std::size_t i) {
  rows_.clear();
  ahead_.reset();
  sketch_ = hal::Json::object();
  floor_ = {};
  ++floor_number_;
  ++sketch_number_;
  for (RecordEntry& entry : reader_.standing(i)) take(std::move(entry));
  reader_.go_to(i);
  at_ = i;
  return read_tick();
}

bool RecordMoments::next() {
  while (at_ + 1 < ticks().size()) {
    ++at_;
    std::erase_if(rows_, [](const auto& entry) { return !entry.second.stream().on_change; });
    if (read_tick()) return true;
  }
  if (rows("pose") == nullptr && !ticks().empty()) go_to(tick_ - 1);  // the last ones are damaged
  return false;
}

}  // namespace tandem::core

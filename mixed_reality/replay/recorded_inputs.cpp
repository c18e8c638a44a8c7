#include "mixed_reality/replay/recorded_inputs.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tandem::mixed_reality {

hal::Result<RecordedInputs> RecordedInputs::open(const std::string& path) {
  auto first = core::RecordReader::open(path);
  if (!first.ok()) return first.error();
  core::RecordReader& looking = first.value();
  std::vector<std::string> robots;
  bool any = false;
  hal::Tick ticks = 0, last = -1;  // of anything
  while (const auto entry = looking.next()) {
    last = std::max(last, entry->tick);
    if (entry->type != core::RecordBlock::Inputs) continue;
    if (!any && entry->tick == -1 && entry->rows->stream().name == TwinState::kName)
      robots = entry->rows->members().ids;
    any = any || !robots.empty();
    if (entry->tick == ticks) ++ticks;
  }
  if (!any) {
    const bool damaged = !looking.damage().empty();
    return hal::Error{
        "record '" + path + "' " +
        (damaged ? "does not say how its real robots began: it is damaged there (" + looking.damage().front() + ")"
                 : "holds no inputs of real robots: none took part, or <record inputs=\"false\"/>, or it "
                   "was written by an earlier release; `tandem run --repeat` does a simulated run again")};
  }
  auto again = core::RecordReader::open(path);
  if (!again.ok()) return again.error();
  RecordedInputs made(std::move(again).value());
  made.robots_ = std::move(robots);
  made.ticks_ = ticks;
  made.end_ = "the run ended";
  if (last >= ticks && !looking.damage().empty())
    made.end_ = "the record is damaged there: " + looking.damage().front();
  else if (looking.cut())
    made.end_ = "the record was cut: its run was killed, or the disk was full";
  return made;
}

const RecordedTick* RecordedInputs::read(hal::Tick tick) {
  if (tick <= at_) return tick == at_ && !now_.inputs.empty() ? &now_ : nullptr;
  now_ = {};
  at_ = tick;
  for (;;) {
    std::optional<core::RecordEntry> entry = ahead_ ? std::exchange(ahead_, {}) : reader_.next();
    if (!entry) break;
    const bool wanted = entry->type == core::RecordBlock::Inputs || entry->type == core::RecordBlock::Checks;
    if (!wanted || entry->tick < tick) continue;
    if (entry->tick > tick) {
      ahead_ = std::move(entry);
      break;
    }
    if (entry->type == core::RecordBlock::Checks)
      now_.checks = entry->bytes;
    else
      now_.inputs.push_back(std::move(*entry->rows));
  }
  return now_.inputs.empty() ? nullptr : &now_;
}

// --- rows ---

/// Finds where the values go. Error: a field is of another type.
hal::Status InputWriter::make(const core::RecordRows& rows, Plan& plan) const {
  plan = {};
  plan.stream = &rows.stream();
  plan.members = &rows.members();
  const std::vector<std::string>& ids = rows.members().ids;
  const auto member = std::find(ids.begin(), ids.end(), id_);
  if (member == ids.end() || rows.stream().set != "input") return {};
  const std::string& name = rows.stream().name;
  if (name == TwinState::kName) {
    plan.type = &hal::row_type<TwinState>();
    plan.to = &entity_.state();
  }
  for (std::size_t i = 0; i < entity_.fusion().size() && plan.type == nullptr; ++i) {
    if (entity_.fusion().type(i).name != name) continue;
    plan.type = &entity_.fusion().type(i);
    plan.to = entity_.fusion().reading(i);
  }
  if (plan.type == nullptr) return {};  // another controller does not read it
  const std::vector<core::RecordField>& fields = rows.stream().fields;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const hal::Field* const field = plan.type->field(fields[f].name);
    if (field == nullptr || field->scalar != fields[f].scalar || field->count != fields[f].count ||
        fields.size() != plan.type->fields.size()) {
      return hal::Error{"'" + name + "' has other fields in the record than in this program ('" + fields[f].name +
                        "'): it was written by another release, or another plug-in"};
    }
    plan.copies.push_back({f, field->offset, field->count * hal::size_of(field->scalar)});
  }
  plan.row = static_cast<std::size_t>(member - ids.begin());
  return {};
}

hal::Status InputWriter::write(const core::RecordRows& rows) {
  const std::string name = rows.stream().title();
  auto found = plans_.find(name);
  if (found == plans_.end()) found = plans_.emplace(name, Plan{}).first;
  Plan& plan = found->second;
  if (plan.stream != &rows.stream() || plan.members != &rows.members()) {
    if (const hal::Status made = make(rows, plan); !made.ok()) return made;
  }
  if (!plan.row) return {};
  plan.type->reset(plan.to);
  for (const Copy& copy : plan.copies) {
    const std::string_view bytes = rows.bytes(copy.field, *plan.row);
    std::memcpy(static_cast<std::byte*>(plan.to) + copy.offset, bytes.data(), std::min(bytes.size(), copy.bytes));
  }
  return {};
}

std::vector<std::string> InputWriter::missing() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < entity_.fusion().size(); ++i) {
    const std::string name(entity_.fusion().type(i).name);
    const auto plan = plans_.find("input " + name);
    if (plan == plans_.end() || !plan->second.row) names.push_back(name);
  }
  return names;
}

}  // namespace tandem::mixed_reality

#include "app/lab/conformance/course.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "app/process/allocations.hpp"
#include "core/space/columns.hpp"

namespace tandem::app {
namespace {

using core::World;

constexpr std::int64_t kCounted = TrialMaker::kCheckpoint + 5;  // from here on allocations are counted

/// The first value in which two moments differ: "robot r3, sensor x, field: 1 and 2".
std::string first_difference(const std::vector<core::StateValue>& a, const std::vector<core::StateValue>& b) {
  const auto all = core::differences(a, b);
  if (all.empty()) return "no value that it can name";
  const core::StateDifference& d = all.front();
  const auto shown = [](const std::string& value) { return value.empty() ? "nothing" : value; };
  return fmt::format("{}, {} {}: {} and {}", d.who, d.what, d.field, shown(d.a), shown(d.b));
}

/// Bytes of a row that no field describes, with whether they may be there only to align what follows.
struct Gap {
  std::size_t begin, end;
  bool padding;
};
std::vector<Gap> gaps_of(const hal::RowType& type) {
  std::vector<bool> described(type.size, false);
  for (const hal::Field& f : type.fields)
    std::fill_n(described.begin() + static_cast<std::ptrdiff_t>(f.offset), f.count * hal::size_of(f.scalar), true);
  std::vector<Gap> gaps;
  for (std::size_t at = 0; at < type.size;) {
    std::size_t end = at;
    while (end < type.size && !described[end]) ++end;
    if (end > at) {
      std::size_t align = 1;  // of what follows, at most the row's
      while (align < type.align && end % (2 * align) == 0) align *= 2;
      gaps.push_back({at, end, end - at < align});
    }
    at = std::max(end, at + 1);
  }
  return gaps;
}

}  // namespace

bool Course::runs() {
  std::string why;
  const auto world = maker_.make(0, why);
  if (world == nullptr) {
    say(Verdict::NotJudged, "worlds", why);
    return false;
  }
  if (const std::string failure = step_to(*world, TrialMaker::kTicks); !failure.empty()) {
    say(Verdict::Fault, "runs", failure);
    return false;
  }
  for (const std::string& incident : world->incidents().first()) {
    if (world->incidents().controllers_thrown > 0) {
      say(Verdict::Fault, "runs", incident);
      return false;
    }
  }
  return true;
}

std::string Course::difference(World& a, World& b, std::int64_t until) {
  while (a.tick() < until && b.tick() < until) {
    if (a.state_hash() != b.state_hash())
      return fmt::format("from tick {} on, first in {}", a.tick(),
                         first_difference(state_values(a.state_view()), state_values(b.state_view())));
    if (a.state() != core::RunState::Running || b.state() != core::RunState::Running) break;
    a.step();
    b.step();
  }
  return a.state_hash() == b.state_hash()
             ? ""
             : fmt::format("in tick {}, in {}", a.tick(),
                           first_difference(state_values(a.state_view()), state_values(b.state_view())));
}

bool Course::repeats() {
  std::string why;
  const auto again = [&](std::int64_t threads) {
    const auto a = maker_.make(0, why);
    const auto b = maker_.make(threads, why);
    return a == nullptr || b == nullptr ? why : difference(*a, *b, TrialMaker::kTicks);
  };
  if (const std::string where = again(0); !where.empty()) {
    say(Verdict::Fault, "repeats",
        "a second run with the same seed differs " + where +
            "; take chance from (seed, robot, tick), and keep state in columns");
    return false;
  }
  for (const std::int64_t threads : {1, 2, 4}) {
    const std::string where = again(threads);
    if (where.empty()) continue;
    say(Verdict::Fault, "threads",
        fmt::format("with {} threads the run differs {}; what a part computes may depend on neither threads nor "
                    "their order",
                    threads, where));
    return false;
  }
  say(Verdict::Good, "threads",
      fmt::format("the same bits again, and for 0, 1, 2 and 4 threads, in {} ticks", TrialMaker::kTicks));
  return true;
}

void Course::checkpoints() {
  std::string why;
  const auto world = maker_.make(0, why);
  const auto plain = maker_.make(0, why);
  if (world == nullptr || plain == nullptr) return say(Verdict::Fault, "checkpoints", why);
  (void)step_to(*world, TrialMaker::kCheckpoint);
  const auto kept = world->snapshot();
  if (!kept.ok()) return say(Verdict::NotJudged, "checkpoints", kept.error().message);
  const std::uint64_t then = world->state_hash();
  (void)step_to(*world, TrialMaker::kTicks);
  (void)step_to(*plain, TrialMaker::kTicks);
  const auto at_end = state_values(plain->state_view());
  if (world->state_hash() != plain->state_hash())
    return say(Verdict::Fault, "checkpoints",
               "a run in which a checkpoint is taken goes on otherwise: in " +
                   first_difference(at_end, state_values(world->state_view())));
  if (const hal::Status back = world->restore(kept.value()); !back.ok())
    return say(Verdict::Fault, "checkpoints", back.error().message);
  if (world->state_hash() != then) return say(Verdict::Fault, "checkpoints", "what is put back is not what was kept");
  (void)step_to(*world, TrialMaker::kTicks);
  if (world->state_hash() != plain->state_hash())
    return say(Verdict::Fault, "checkpoints",
               fmt::format("a run that goes back to tick {} and on to {} ends otherwise, in {}; something is kept "
                           "outside of the columns, in a member perhaps",
                           TrialMaker::kCheckpoint, TrialMaker::kTicks,
                           first_difference(at_end, state_values(world->state_view()))));
  if (const hal::Status reset = world->reset(world->seed()); !reset.ok())
    return say(Verdict::Fault, "checkpoints", "it cannot be reset: " + reset.error().message);
  (void)step_to(*world, TrialMaker::kTicks);
  if (world->state_hash() != plain->state_hash())
    return say(Verdict::Fault, "checkpoints",
               "a run that was reset differs from a new one, in " +
                   first_difference(at_end, state_values(world->state_view())));
  say(Verdict::Good, "checkpoints", "going back, and a reset, change no bit");
}

std::optional<std::uint64_t> allocations_of(const TrialMaker& maker) {
  std::string why;
  const auto world = maker.make(0, why);
  if (world == nullptr) return std::nullopt;
  (void)step_to(*world, TrialMaker::kCheckpoint);
  // A second time over the same ticks: lists that grow with what robots meet have grown in the first.
  if (const auto kept = world->snapshot(); kept.ok()) {
    (void)step_to(*world, TrialMaker::kTicks);
    (void)world->restore(kept.value());
  }
  (void)step_to(*world, kCounted);
  const AllocationCount allocations;
  (void)step_to(*world, TrialMaker::kTicks);
  return allocations.count();
}

void Course::allocates(std::optional<std::uint64_t> usual) {
  const auto count = allocations_of(maker_);
  if (!count) return say(Verdict::NotJudged, "memory", "this build of the program cannot count allocations");
  const std::uint64_t more = *count > usual.value_or(0) ? *count - usual.value_or(0) : 0;
  if (more == 0) return say(Verdict::Good, "memory", "its steps allocate nothing");
  say(Verdict::Fault, "memory",
      fmt::format("{} allocations by `new` in {} ticks; make room when it is made, or the first time", more,
                  TrialMaker::kTicks - kCounted));
}

std::vector<std::string> columns_of(const TrialMaker& maker) {
  std::vector<std::string> names;
  std::string why;
  const auto world = maker.make(0, why);
  if (world == nullptr) return names;
  for (const auto& column : world->space().stores().columns.all()) {
    if (!column->of_block.empty()) names.emplace_back(column->type->name);
  }
  return names;
}

void Course::counts_state(const std::vector<std::string>& known) {
  std::string why;
  const auto world = maker_.make(0, why);
  if (world == nullptr) return;
  (void)step_to(*world, TrialMaker::kTicks);
  const core::SpaceStores& stores = world->space().stores();
  std::size_t values = 0;
  std::string own;
  for (const auto& column : stores.columns.all()) {
    const hal::RowType& type = *column->type;
    if (column->of_block.empty() || std::find(known.begin(), known.end(), type.name) != known.end()) continue;
    own += (own.empty() ? "" : ", ") + std::string(type.name);
    for (const Gap& gap : gaps_of(type)) {
      bool changed = false;
      for (std::size_t b = 0; b < stores.blocks.size() && !changed; ++b) {
        const std::byte* const rows = column->array(b);
        for (std::size_t i = 0; rows != nullptr && i < stores.blocks[b].used && !changed; ++i)
          changed = std::memcmp(rows + i * type.size + gap.begin,
                                static_cast<const std::byte*>(type.initial) + gap.begin, gap.end - gap.begin) != 0;
      }
      if (!changed) continue;
      const std::string where = fmt::format("bytes {} to {} of the column '{}' change, and no field describes them",
                                            gap.begin, gap.end - 1, type.name);
      if (!gap.padding) return say(Verdict::Fault, "state", where + ": add what lies there to its describe()");
      say(Verdict::NotJudged, "state", where + ": that may be padding, or a member that describe() leaves out");
    }
    for (std::size_t b = 0; b < stores.blocks.size(); ++b) {
      std::byte* const row = column->array(b);
      if (row == nullptr || stores.blocks[b].used == 0) continue;
      for (const hal::Field& field : type.fields) {
        if (!field.used_by.empty()) continue;
        std::byte& byte = row[field.offset];
        const std::uint64_t before = world->state_hash();
        byte ^= std::byte{1};
        const bool counts = world->state_hash() != before;
        byte ^= std::byte{1};
        ++values;
        if (!counts)
          return say(
              Verdict::Fault, "state",
              fmt::format("the field '{}' of the column '{}' does not change the fingerprint", field.name, type.name));
      }
      break;  // one robot stands for all
    }
  }
  say(Verdict::Good, "state",
      own.empty() ? "keeps none of its own"
                  : fmt::format("{} fields count in the fingerprint (columns {})", values, own));
}

}  // namespace tandem::app

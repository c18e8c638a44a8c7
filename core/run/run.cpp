#include "core/run/run.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>

namespace tandem::core {
World& Run::world() const {
  if (world_ == nullptr) throw std::logic_error("this run has no world: it drives a robot");
  return *world_;
}

void Run::add(std::unique_ptr<RunPart> part) {
  if (part == nullptr) return;
  const RunTurn turn = part->turn();
  const auto behind = [turn](const Row& row) { return turn < row.part->turn(); };
  rows_.insert(std::ranges::find_if(rows_, behind), Row{part.get()});
  parts_.push_back(std::move(part));
}

Run::~Run() {
  while (!parts_.empty()) parts_.pop_back();
}

bool Run::go() {
  if (!begin()) return false;
  while (tick()) {
  }
  end();
  return true;
}

void Run::end() {
  in_reverse("finish", [this](RunPart& part) { return part.finish(*this); });
  stepped_->finish();
  in_reverse("close", [this](RunPart& part) { return part.close(*this); });
}

void Run::leave() {
  in_reverse("finish", [this](RunPart& part) { return part.finish(*this); });
  in_reverse("close", [this](RunPart& part) { return part.close(*this); });
}

/// One call of a part: what it throws or returns as an error is told in its name. @returns whether it was well.
template <class Call>
bool Run::asked(Row& row, std::string_view when, Call&& call) {
  hal::Status done;
  try {
    done = call(*row.part);
  } catch (const std::exception& e) {
    done = hal::Error{std::string(e.what())};
  } catch (...) {
    done = hal::Error{"it threw"};
  }
  if (done.ok()) return true;
  row.failed = broken_ = true;
  fail("part '" + std::string(row.part->name()) + "', " + std::string(when) + ": " + done.error().message);
  return false;
}

bool Run::join() {
  const bool joined = std::ranges::all_of(rows_, [this](Row& row) {
    row.joined = true;
    return asked(row, "join", [this](RunPart& part) { return part.join(*this); });
  });
  if (!joined) in_reverse("finish", [this](RunPart& part) { return part.finish(*this); });
  return joined;
}

/// The turns of a call that tells whether to go on with the next part.
template <class Call>
bool Run::in_order(std::string_view when, Call&& call) {
  return std::ranges::all_of(rows_, [&](Row& row) {
    bool on = true;
    const bool well = row.failed || asked(row, when, [&](RunPart& part) -> hal::Status {
                        on = call(part);
                        return {};
                      });
    return well && on;
  });
}

bool Run::before_tick() {
  return !broken_ && in_order("before_tick", [this](RunPart& part) {
    const bool on = part.before_tick(*this);
    if (!on) ended_by_ = &part;
    return on;
  });
}

void Run::after_tick() {
  (void)in_order("after_tick", [this](RunPart& part) { return part.after_tick(*this); });
}

template <class Call>
void Run::in_reverse(std::string_view when, Call&& call) {
  for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) {
    if (row->joined) (void)asked(*row, when, call);
  }
}

void Run::tell(hal::Tick tick, const hal::Json& event) {
  (void)in_order("event", [&](RunPart& part) {
    part.event(tick, event);
    return true;
  });
}

void Run::fail(const std::string& why) {
  if (failure_.empty()) failure_ = why;
}

std::vector<std::string_view> Run::order() const {
  std::vector<std::string_view> names;
  for (const Row& row : rows_) names.push_back(row.part->name());
  return names;
}

bool Length::before_tick(Run& run) {
  return run.running() && (ticks_ == 0 || run.tick_count() < ticks_) && !run.stopped();
}

}  // namespace tandem::core

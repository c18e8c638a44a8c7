#include "mixed_reality/record_tracker/record_tracker.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <sstream>
#include <thread>
#include <vector>

#include "bridges/sighting_box.hpp"
#include "core/record/pattern.hpp"
#include "core/record/record_moments.hpp"
#include "core/record/record_reader.hpp"
#include "hal/element.hpp"
#include "hal/element_options.hpp"
#include "hal/monotonic.hpp"

namespace tandem::mixed_reality {
namespace {

using bridges::Sighting;

using hal::monotonic_ns;

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string word; in >> word;) all.push_back(word);
  return all;
}

bool holds_poses(const core::RecordEntry& entry) {
  return entry.rows && entry.rows->stream().of == "robot" && entry.rows->stream().set == "pose";
}

class RecordTracker final : public bridges::Tracker {
 public:
  RecordTracker(core::RecordReader reader, const RecordTrackerOptions& options, std::int64_t ticks_per_second)
      : reader_(std::move(reader)),
        patterns_(words(options.entities)),
        from_ns_(static_cast<hal::TimeNs>(options.from_s * 1e9)),
        ticks_per_second_(ticks_per_second) {}
  ~RecordTracker() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    stopped_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  hal::Status start() override {
    if (!thread_.joinable()) thread_ = std::thread([this] { play(); });
    return {};
  }
  std::size_t take(std::span<Sighting> into) noexcept override { return box_.take(into); }
  bridges::TrackerReport report() const override { return box_.report(); }

 private:
  void play();
  /// False: it is to end.
  bool wait_until(hal::TimeNs at_ns);
  void tell(const core::RecordRows& rows, hal::TimeNs time_ns);

  core::RecordReader reader_;
  std::vector<std::string> patterns_;
  hal::TimeNs from_ns_;
  std::int64_t ticks_per_second_;
  bridges::SightingBox box_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::thread thread_;
};

void RecordTracker::play() {
  const hal::TimeNs began_ns = monotonic_ns();
  while (const auto entry = reader_.next()) {
    if (!holds_poses(*entry)) continue;
    const hal::TimeNs time_ns = hal::time_of_tick(entry->tick + 1, ticks_per_second_);  // after that tick
    if (time_ns < from_ns_) continue;
    if (!wait_until(began_ns + time_ns - from_ns_)) return;
    tell(*entry->rows, time_ns);
  }
  box_.set_trouble("the record is over");
}

bool RecordTracker::wait_until(hal::TimeNs at_ns) {
  std::unique_lock lock(mutex_);
  stopped_.wait_for(lock, std::chrono::nanoseconds(std::max<hal::TimeNs>(0, at_ns - monotonic_ns())),
                    [this] { return stop_; });
  return !stop_;
}

void RecordTracker::tell(const core::RecordRows& rows, hal::TimeNs time_ns) {
  const auto x = core::field_of(rows, "x"), y = core::field_of(rows, "y"), heading = core::field_of(rows, "heading");
  if (!x || !y || !heading) return box_.set_trouble("the record's poses have no x, y and heading");
  std::vector<Sighting> seen;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    Sighting s;
    const std::string& id = rows.members().ids[row];
    const bool chosen = std::any_of(patterns_.begin(), patterns_.end(),
                                    [&](const std::string& pattern) { return core::fits_pattern(id, pattern); });
    if (!chosen || !s.set_name(id)) continue;
    s.p_m = {rows.value(*x, row), rows.value(*y, row), 0.0};
    s.heading_rad = rows.value(*heading, row);
    if (!std::isfinite(s.p_m[0]) || !std::isfinite(s.p_m[1]) || !std::isfinite(*s.heading_rad)) continue;
    s.stamp_ns = time_ns;
    s.received_ns = monotonic_ns();
    seen.push_back(s);
  }
  box_.put(seen, false);
}

struct Opened {
  core::RecordReader reader;
  std::int64_t ticks_per_second;
};

hal::Result<Opened> open(const bridges::TrackerRequest& request) {
  const auto options = bridges::options_of<RecordTrackerOptions>(request);
  if (options.file.empty()) return hal::Error{"'file' must name a record"};
  const std::string path = hal::path_beside(options.file, request.file);
  auto reader = core::RecordReader::open(path);
  if (!reader.ok()) return reader.error();
  const auto rate = reader.value().start().find("ticks_per_second");
  if (rate == reader.value().start().end() || !rate->is_number_integer() || rate->get<std::int64_t>() < 1)
    return hal::Error{"the record '" + path + "' does not say how long its ticks are"};
  if (reader.value().ticks().empty()) return hal::Error{"the record '" + path + "' has no poses of robots"};
  const std::int64_t ticks_per_second = rate->get<std::int64_t>();
  if (hal::to_seconds(hal::time_of_tick(reader.value().ticks().back() + 1, ticks_per_second)) < options.from_s)
    return hal::Error{"the record '" + path + "' ends before 'from'"};
  return Opened{std::move(reader).value(), ticks_per_second};
}

const bridges::TrackerType kType{.name = "record",
                                 .summary = "Poses of a record, played back as fast as they were.",
                                 .make = &make_record_tracker,
                                 .check = &check_record_tracker};

}  // namespace

bridges::MadeTracker make_record_tracker(const bridges::TrackerRequest& request, const hal::Log&) {
  auto opened = open(request);
  if (!opened.ok()) return opened.error();
  return std::unique_ptr<bridges::Tracker>(std::make_unique<RecordTracker>(
      std::move(opened.value().reader), bridges::options_of<RecordTrackerOptions>(request),
      opened.value().ticks_per_second));
}

hal::Status check_record_tracker(const bridges::TrackerRequest& request) {
  const auto opened = open(request);
  return opened.ok() ? hal::Status{} : opened.error();
}

void register_record_tracker(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<RecordTrackerOptions>("tracker of record"));
}

}  // namespace tandem::mixed_reality

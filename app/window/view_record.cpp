#include "app/window/view_record.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "app/experiment/plugins.hpp"
#include "app/live/watch.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/window/source_view.hpp"
#include "app/window/view_messages.hpp"
#include "core/live/inspection.hpp"
#include "core/record/block_file.hpp"
#include "core/record/record_source.hpp"
#include "core/view/record_drawing.hpp"
#include "hal/input_file.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::app {
namespace {

using core::RecordMoments;
using core::RecordRows;
using core::RecordSource;
using hal::Json;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t kMostPosted = 1000;
constexpr auto kLook = 50ms;  // for a stop that nobody notifies of
constexpr auto kStateEvery = 250ms;
constexpr auto kHistoryPatience = 2s;
constexpr std::size_t kMostSamples = 10'000;
constexpr double kSlowest = 0.001, kFastest = 1e6;

Json refusal(const std::string& why) {
  return {{"ok", false}, {"error", why}};
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

using hal::text_of;
using hal::whole_of;

std::optional<std::size_t> row_of(const RecordRows& rows, const std::string& id) {
  const std::vector<std::string>& ids = rows.members().ids;
  const auto found = std::find(ids.begin(), ids.end(), id);
  if (found == ids.end()) return {};
  return static_cast<std::size_t>(found - ids.begin());
}

/// Plays a record on one thread; others post commands.
class RecordPlayer final : public core::Watched {
 public:
  RecordPlayer(const std::string& path, RecordSource record, const hal::Catalog& catalog, window::Window& window,
               const HoldOptions& hold)
      : path_(path),
        record_(std::move(record)),
        window_(window),
        view_(catalog, hal::Log([this](hal::Severity, std::string_view text) {
                window_.tell(log_.entry(record_.ticks_done(), "log", text));
              })),
        paused_(hold.paused),
        speed_(hold.speed.value_or(1.0)) {
    publish();
  }

  /// Fills the window, and has it take commands.
  void greet();
  void run(const std::atomic<bool>& stop);

  void post(Json command, window::WindowReply reply) override;
  core::LiveState state() const override;
  void add_command(std::string name, core::LiveCommand command) override {
    added_[std::move(name)] = std::move(command);
  }
  /// On the thread that plays.
  WatchSight sight() { return {record_.space(), record_.ticks_done(), record_.ticks_per_second()}; }

 private:
  struct Posted {
    Json command;
    window::WindowReply reply;
  };
  void carry_out_posted();
  Json carry_out(const Json& command);
  Json play(const Json& command);
  Json set_speed(const Json& speed);
  Json go_to(const Json& command);
  Json history(const Json& command);
  Json picture();
  Json here() const { return {{"ok", true}, {"tick", moments_.tick() + 1}}; }
  void begin_schedule();
  Clock::time_point due() const;
  void show(bool settled);
  void publish();
  void tell_state();
  std::optional<hal::Tick> next_tick() const;

  std::string path_;
  RecordSource record_;
  const RecordMoments& moments_ = record_.moments();
  std::optional<RecordMoments> past_;  // for histories, which go elsewhere
  window::Window& window_;
  LogMessages log_;
  SourceView view_;
  bool paused_ = false;
  std::optional<double> speed_;
  std::int64_t steps_wanted_ = 0;
  Clock::time_point anchor_, state_told_;
  hal::Tick anchor_tick_ = 0;
  std::map<std::string, core::LiveCommand, std::less<>> added_;
  mutable std::mutex lock_;
  std::condition_variable changed_;
  std::deque<Posted> posted_;  // with `lock_`, as the next
  core::LiveState state_;
};

void RecordPlayer::greet() {
  const Json& start = moments_.start();
  Json hello = hello_message(text_of(start, "experiment"), "record", record_.seed(), record_.ticks_per_second(),
                             {"pause", "back"}, core::areas_of_json(start.value("areas", Json::array())));
  hello["layers"] = view_.layers_json(record_.space());
  hello["states"] = core::published_names(record_.space());
  window_.tell(std::move(hello));
  for (const core::RecordEvent& event : record_.moments().events()) {
    std::string text = text_of(event.json, "text");
    if (const auto action = event.json.find("action"); action != event.json.end()) text = action_text(*action);
    if (text.empty()) text = hal::to_text(event.json);
    window_.tell(log_.entry(event.tick + 1, text_of(event.json, "kind"), text));
  }
  for (const std::string& line : moments_.damage()) window_.tell(log_.entry(0, "incident", "record: " + line));
  window_.set_commands([this](Json command, window::WindowReply reply) { post(std::move(command), std::move(reply)); });
  window_.set_pictures([this](const std::string& name, window::WindowFileReply reply) {
    post({{"do", "picture"}}, [name, reply](const Json& answer) {
      const std::string svg = text_of(answer, "svg");
      reply(svg.empty() ? window::WindowFile{"", "", text_of(answer, "error")} : picture_file(name, svg));
    });
  });
  window_.on_wish([this] { post({{"do", "show"}}, {}); });
}

void RecordPlayer::post(Json command, window::WindowReply reply) {
  {
    const std::lock_guard hold(lock_);
    if (posted_.size() < kMostPosted) {
      posted_.push_back({std::move(command), std::move(reply)});
      reply = nullptr;
    }
  }
  if (reply) reply(refusal("too many commands wait to be carried out: send fewer"));
  changed_.notify_one();
}

void RecordPlayer::carry_out_posted() {
  for (;;) {
    Posted next;
    {
      const std::lock_guard hold(lock_);
      if (posted_.empty()) return;
      next = std::move(posted_.front());
      posted_.pop_front();
    }
    Json answer = here();
    if (const auto added = added_.find(text_of(next.command, "do")); added != added_.end()) {
      const hal::Result<Json> done = added->second(next.command);
      if (!done.ok()) answer = refusal(done.error().message);
    } else {
      answer = carry_out(next.command);
      publish();
      show(true);
    }
    if (next.reply) next.reply(answer);
  }
}

Json RecordPlayer::carry_out(const Json& command) {
  const std::string name = text_of(command, "do");
  if (name == "show") return here();
  if (name == "play") return play(command);
  if (name == "speed") {
    const auto times = command.find("times");
    return times == command.end() ? refusal("\"times\" is missing") : set_speed(*times);
  }
  if (name == "go_to") return go_to(command);
  if (name == "history") return history(command);
  if (name == "picture") return picture();
  if (name == "pause") {
    paused_ = true;
    steps_wanted_ = 0;
    return here();
  }
  if (name == "step") {
    paused_ = true;
    steps_wanted_ = std::clamp<std::int64_t>(whole_of(command, "ticks", 1), 1, 1'000'000);
    return here();
  }
  return refusal("'" + name + "' cannot be done: this is a record of a run that is over");
}

Json RecordPlayer::play(const Json& command) {
  if (const auto speed = command.find("speed"); speed != command.end()) {
    if (Json answer = set_speed(*speed); answer["ok"] == false) return answer;
  }
  if (!next_tick()) record_.go_to(moments_.ticks().front() + 1);
  paused_ = false;
  steps_wanted_ = 0;
  begin_schedule();
  return here();
}

Json RecordPlayer::set_speed(const Json& speed) {
  if (!speed.is_null() && !(speed.is_number() && speed.get<double>() >= kSlowest && speed.get<double>() <= kFastest))
    return refusal("a speed is a number from 0.001 to 1000000, times real time, or null: as fast as possible");
  speed_ = speed.is_null() ? std::optional<double>() : speed.get<double>();
  begin_schedule();
  return here();
}

Json RecordPlayer::go_to(const Json& command) {
  const std::int64_t tick = whole_of(command, "tick", -1);
  if (tick < 0) return refusal("\"tick\" is a whole number from 0 on");
  record_.go_to(tick);
  paused_ = true;
  steps_wanted_ = 0;
  return here();
}

Json RecordPlayer::picture() {
  return {{"ok", true}, {"svg", core::to_svg(core::drawing_of(record_, {}, nullptr))}};
}

Json RecordPlayer::history(const Json& command) {
  const std::string robot = text_of(command, "robot"), role = text_of(command, "role");
  const std::string field = text_of(command, "field");
  const auto index = static_cast<std::size_t>(std::max<std::int64_t>(0, whole_of(command, "index", 0)));
  const std::string title = role == "pose" ? "pose" : role == "published" ? "" : role + " " + text_of(command, "port");
  const std::vector<hal::Tick>& ticks = moments_.ticks();
  const hal::Tick from = std::max(whole_of(command, "from", 0) - 1, ticks.front());
  const hal::Tick to = std::min(whole_of(command, "to", moments_.tick() + 1) - 1, ticks.back());
  const auto first = std::lower_bound(ticks.begin(), ticks.end(), from);
  const auto end = std::upper_bound(ticks.begin(), ticks.end(), to);
  if (first >= end) return refusal("the record has no ticks there");
  const auto there = static_cast<std::size_t>(end - first);
  const std::size_t stride =
      std::max<std::size_t>({1, static_cast<std::size_t>(std::max<std::int64_t>(1, whole_of(command, "every", 1))),
                             (there + kMostSamples - 1) / kMostSamples});
  if (!past_) {
    auto opened = RecordMoments::open(path_);
    if (!opened.ok()) return refusal(opened.error().message);
    past_ = std::move(opened).value();
  }
  Json answer = {{"ok", true}}, at = Json::array(), values = Json::array();
  const Clock::time_point until = Clock::now() + kHistoryPatience;
  bool found = false;
  for (auto tick = first; tick < end;
       tick += std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(stride), end - tick)) {
    if (Clock::now() > until) {
      answer["bounded"] =
          "the first " + std::to_string(at.size()) + " values: to read more takes longer than two seconds";
      break;
    }
    if (stride > 1 || tick == first || !past_->next()) past_->go_to(*tick);
    Json value;
    past_->each([&](const std::string& name, const RecordRows& rows) {
      if (role == "published" ? rows.stream().set != "state" : name != title) return;
      const auto f = core::field_of(rows, field);
      const auto row = row_of(rows, robot);
      if (!f || !row) return;
      found = true;
      if (index < rows.used(*f, *row)) value = number_or_null(rows.value(*f, *row, index));
    });
    at.push_back(*tick + 1);
    values.push_back(std::move(value));
  }
  if (!found)
    return refusal("the record holds no '" + field + "' of " + (title.empty() ? role : title) + " of robot '" + robot +
                   "' there");
  answer["ticks"] = std::move(at);
  answer["values"] = std::move(values);
  return answer;
}

std::optional<hal::Tick> RecordPlayer::next_tick() const {
  const auto next = std::upper_bound(moments_.ticks().begin(), moments_.ticks().end(), moments_.tick());
  if (next == moments_.ticks().end()) return {};
  return *next;
}

void RecordPlayer::begin_schedule() {
  anchor_ = Clock::now();
  anchor_tick_ = moments_.tick();
}

Clock::time_point RecordPlayer::due() const {
  const double s = static_cast<double>(next_tick().value_or(moments_.tick()) - anchor_tick_) /
                   (static_cast<double>(moments_.ticks_per_second()) * *speed_);
  return anchor_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

void RecordPlayer::run(const std::atomic<bool>& stop) {
  begin_schedule();
  tell_state();
  while (!stop.load(std::memory_order_relaxed)) {
    carry_out_posted();
    if (!paused_ && !next_tick()) {
      paused_ = true;
      publish();
      show(true);
    }
    Clock::time_point until = Clock::now() + kLook;
    bool go = steps_wanted_ > 0;
    if (!paused_ && !go) {
      go = !speed_ || due() <= Clock::now();
      if (!go) until = std::min(until, due());
    }
    if (go) {
      const bool there_was = record_.next();
      if (there_was && view_.notes()) view_.note(record_.observation());
      const bool stepped = steps_wanted_ > 0 && (--steps_wanted_ == 0 || !there_was);
      if (stepped) steps_wanted_ = 0;
      publish();
      if (stepped) {
        show(true);
      } else if (window_.wants_frame()) {
        show(false);
      } else if (!speed_ && window_.watched()) {
        // As fast as somebody can see it, no faster.
        std::unique_lock hold(lock_);
        changed_.wait_for(hold, 1ms, [this] { return !posted_.empty(); });
      }
      continue;
    }
    std::unique_lock hold(lock_);
    changed_.wait_until(hold, until, [this] { return !posted_.empty(); });
  }
}

void RecordPlayer::show(bool settled) {
  if (!window_.watched()) return;
  view_.show(window_, record_.observation(), record_.ticks_done(), settled,
             [this](const std::vector<std::string>& robots) {
               return core::inspection_of(record_.space(), record_.ticks_done(), record_.ticks_per_second(), robots);
             });
  if (settled || Clock::now() - state_told_ >= kStateEvery) tell_state();
}

core::LiveState RecordPlayer::state() const {
  const std::lock_guard hold(lock_);
  return state_;
}

/// Brings what others see up to date.
void RecordPlayer::publish() {
  const std::lock_guard hold(lock_);
  state_.paused = paused_ && steps_wanted_ == 0;
  state_.speed = speed_;
  state_.reached = paused_ ? 0.0 : speed_.value_or(0.0);
  state_.tick = record_.ticks_done();
  state_.latest = moments_.ticks().back() + 1;
  state_.first = moments_.ticks().front() + 1;
  state_.seed = record_.seed();
}

void RecordPlayer::tell_state() {
  state_told_ = Clock::now();
  Json message = {{"type", "state"}};
  message.update(core::to_json(state()));
  window_.tell(std::move(message));
}

}  // namespace

bool is_record(const std::string& path) {
  if (!hal::check_input_file(path, "").ok()) return false;
  std::string start(core::kBlockFileStart.size(), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  constexpr std::size_t kName = 14;  // "TANDEM RECORD ": other versions are told by who reads it
  return in.gcount() >= static_cast<std::streamsize>(kName) &&
         start.substr(0, kName) == core::kBlockFileStart.substr(0, kName);
}

int view_record(const RunOptions& options, const std::atomic<bool>& stop) {
  const std::string& path = options.experiment;
  auto start = core::RecordReader::open(path);
  if (!start.ok()) return complain(kBadInput, start.error().message);
  const auto known = kinds_of_settings(text_of(start.value().start(), "settings"), path);
  auto record = RecordSource::open(path, &known->catalog);
  if (!record.ok()) return complain(kBadInput, record.error().message);
  if (record.value().moments().cut()) say("record '" + path + "': it was cut; shown is what is there");
  if (const hal::Status fits = Watch::check(options.watch, record.value().space()); !fits.ok())
    return complain(kBadInput, fits.error().message);
  auto window = open_window(options.view);
  if (!window.ok()) return complain(kBadInput, window.error().message);
  const std::string experiment = record.value().experiment();
  const std::int64_t ticks_per_second = record.value().ticks_per_second();
  RecordPlayer player(path, std::move(record).value(), known->catalog, *window.value(), options.hold);
  std::optional<Watch> watch;
  if (options.watch.watch)
    watch.emplace(options.watch, Watch::Run{player,
                                            [&player] { return player.sight(); },
                                            experiment,
                                            player.state().latest,
                                            ticks_per_second,
                                            {},
                                            &request_stop});
  player.greet();
  announce(*window.value(), options.view);
  player.run(stop);
  watch.reset();
  window.value().reset();  // its thread uses the player
  return kDone;
}

}  // namespace tandem::app

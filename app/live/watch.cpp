#include "app/live/watch.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "app/process/screen.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "core/record/trajectory.hpp"
#include "core/scenario/element.hpp"

namespace tandem::app {
namespace {

constexpr auto kFrame = std::chrono::milliseconds(100);
constexpr auto kLine = std::chrono::seconds(1);
constexpr std::size_t kMostMessages = 200;  // kept for the screen
constexpr std::size_t kMostLeft = 20;       // that stand on the terminal after it, besides errors
constexpr double kSpeeds[] = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0};  // beyond: as fast as possible

/// Between the thread that steps, who else says something, and the one that draws. Calls that are under way may outlive
/// the watch.
struct Shared {
  std::mutex lock;
  std::condition_variable changed;
  bool over = false;
  WatchWish wish;
  bool asked = false;  // and not answered yet
  int commands = 0;    // of keys, the same
  std::optional<WatchMoment> moment;
  std::string note;
  std::deque<std::string> messages;
};

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    if (c != ' ' && c != ',') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::exchange(word, {}));
    }
  }
  return words;
}

}  // namespace

struct Watch::Impl {
  Impl(const WatchRequest& request, const Run& r) : run(r) {
    shared->wish.robots = request.robots;
    shared->wish.port = request.port;
    page.experiment = run.experiment;
    page.ticks = run.ticks;
    page.ticks_per_second = run.ticks_per_second;
    page.port = request.port;
  }

  Run run;
  std::shared_ptr<Shared> shared = std::make_shared<Shared>();
  std::optional<SayElsewhere> says;
  std::optional<Screen> screen;
  WatchPage page;                    // of the thread that draws
  std::optional<std::string> typed;  // robots that are being chosen
  bool paused = false;               // as keys have asked for, whether or not that has happened yet
  std::optional<double> speed;       // the same
  std::thread thread;

  void ask();
  void post(hal::Json command);
  void take();
  void wish(const std::function<void(WatchWish&)>& change);
  void draw();
  void keys(std::string_view pressed);
  void key(char c);
  void type(char c);
  void scroll(std::ptrdiff_t rows);
  void other_port();
  void other_speed(int step);
  void work();
  void work_in_lines();
};

/// Asks for another moment, unless one is still asked for.
void Watch::Impl::ask() {
  {
    const std::lock_guard hold(shared->lock);
    if (shared->asked) return;
    shared->asked = true;
  }
  run.watched.post({{"do", "watch"}}, [shared = shared](const hal::Json&) {
    const std::lock_guard hold(shared->lock);
    shared->asked = false;
    shared->changed.notify_all();
  });
}

void Watch::Impl::post(hal::Json command) {
  {
    const std::lock_guard hold(shared->lock);
    ++shared->commands;
  }
  run.watched.post(std::move(command), [shared = shared](const hal::Json& answer) {
    const std::lock_guard hold(shared->lock);
    --shared->commands;
    shared->note = answer.value("ok", false) ? std::string() : answer.value("error", std::string("it did not work"));
    shared->changed.notify_all();
  });
}

void Watch::Impl::take() {
  const core::LiveState now = run.watched.state();
  const std::lock_guard hold(shared->lock);
  page.state = now;
  if (shared->commands == 0) {
    paused = now.paused;
    speed = now.speed;
  }
  if (shared->moment) page.moment = std::move(*std::exchange(shared->moment, std::nullopt));
  page.messages = shared->messages;
  page.note = shared->note;
  page.port = shared->wish.port;
}

void Watch::Impl::wish(const std::function<void(WatchWish&)>& change) {
  const std::lock_guard hold(shared->lock);
  change(shared->wish);
  shared->note.clear();
}

void Watch::Impl::draw() {
  const Screen::Size size = screen->size();
  const std::size_t rows = rows_of(page, size);
  const Screen::Size map = map_room(page, size);
  wish([&](WatchWish& w) {
    w.rows = rows;
    w.map = map;
  });
  page.prompt = typed ? "robots: " + printable(*typed) + "_" : std::string();
  screen->show(lay_out(page, size));
}

void Watch::Impl::scroll(std::ptrdiff_t rows) {
  wish([&](WatchWish& w) {
    const auto most = static_cast<std::ptrdiff_t>(page.moment.chosen > w.rows ? page.moment.chosen - w.rows : 0);
    w.first =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(w.first) + rows, 0, most));
  });
}

/// What controllers publish, then each port of the first robot in turn.
void Watch::Impl::other_port() {
  std::vector<std::string> all{""};
  all.insert(all.end(), page.moment.ports.begin(), page.moment.ports.end());
  wish([&](WatchWish& w) {
    auto at = std::find(all.begin(), all.end(), w.port);
    if (at == all.end())
      at = std::find_if(all.begin(), all.end(), [&](const std::string& name) { return name.ends_with(" " + w.port); });
    w.port = at == all.end() || at + 1 == all.end() ? "" : *(at + 1);
  });
}

void Watch::Impl::other_speed(int step) {
  const double* const end = std::end(kSpeeds);
  const double* at = speed ? std::lower_bound(std::begin(kSpeeds), end, *speed - 1e-9) : end;
  if (step > 0 && at != end) ++at;
  if (step < 0 && at != std::begin(kSpeeds)) --at;
  speed = at == end ? std::optional<double>() : *at;
  post({{"do", "speed"}, {"times", speed ? hal::Json(*speed) : hal::Json(nullptr)}});
}

void Watch::Impl::type(char c) {
  constexpr char kEscape = '\033', kDelete = '\177', kBack = '\b';
  if (c == '\n' || c == '\r') {
    wish([&](WatchWish& w) {
      w.robots = words_of(*typed);
      w.first = 0;
    });
    typed.reset();
  } else if (c == kEscape) {
    typed.reset();
  } else if (c == kDelete || c == kBack) {
    if (!typed->empty()) typed->pop_back();
  } else if (static_cast<unsigned char>(c) >= 0x20 && typed->size() < 200) {
    *typed += c;
  }
}

void Watch::Impl::key(char c) {
  switch (c) {
    case ' ':
      paused = !paused;
      return post({{"do", paused ? "pause" : "play"}});
    case '+':
    case '=':
      return other_speed(1);
    case '-':
      return other_speed(-1);
    case '/':
      typed.emplace();
      return;
    case '\t':
      return other_port();
    case 'j':
      return scroll(1);
    case 'k':
      return scroll(-1);
    case 'q':
      return run.end();
    default:
      return wish([](WatchWish&) {});  // takes the note away
  }
}

void Watch::Impl::keys(std::string_view pressed) {
  while (!pressed.empty()) {
    if (!typed && pressed.size() >= 3 && (pressed.starts_with("\033[") || pressed.starts_with("\033O"))) {
      const auto page_rows = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, page.moment.robots.size()));
      const char which = pressed[2];
      if (which == 'A') scroll(-1);
      if (which == 'B') scroll(1);
      if (which == '5') scroll(-page_rows);
      if (which == '6') scroll(page_rows);
      pressed.remove_prefix(pressed.size() > 3 && pressed[3] == '~' ? 4 : 3);
      continue;
    }
    if (!typed && pressed.front() == '.') {
      const std::size_t ticks = std::min(pressed.find_first_not_of('.'), pressed.size());
      paused = true;
      post({{"do", "step"}, {"ticks", ticks}});
      pressed.remove_prefix(ticks);
      continue;
    }
    if (typed)
      type(pressed.front());
    else
      key(pressed.front());
    pressed.remove_prefix(1);
  }
}

void Watch::Impl::work() {
  auto next = std::chrono::steady_clock::now();
  bool comes_back = false;
  for (;;) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= next) {
      next = now + kFrame;
      comes_back = continued().exchange(false) || comes_back;
      if (comes_back) comes_back = !screen->come_back();
      take();
      draw();
      ask();
    }
    {
      const std::lock_guard hold(shared->lock);
      if (shared->over) return;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next - std::chrono::steady_clock::now());
    const std::string pressed = screen->keys(static_cast<int>(std::max<std::int64_t>(1, left.count())));
    if (pressed.empty()) continue;
    keys(pressed);
    take();
    draw();
  }
}

void Watch::Impl::work_in_lines() {
  std::unique_lock hold(shared->lock);
  for (;;) {
    if (shared->changed.wait_for(hold, kLine, [this] { return shared->over; })) return;
    hold.unlock();
    ask();
    hold.lock();
    shared->changed.wait(hold, [this] { return shared->over || !shared->asked; });
    if (shared->over) return;
    hold.unlock();
    take();
    std::fprintf(stderr, "%s\n", summary(page).c_str());
    hold.lock();
  }
}

hal::Status Watch::check(const WatchRequest& request, const core::Space& space) {
  std::vector<std::string> names, ports;
  bool fits = false, found = request.port.empty();
  for (std::size_t i = 0; i < space.robot_count() && !(fits && found); ++i) {
    const core::RobotId robot = space.robot(i);
    const std::string name = space.robot_name(robot);
    names.push_back(name);
    const auto fit = [&](const std::string& pattern) { return core::fits_pattern(name, pattern); };
    if (!request.robots.empty() && std::none_of(request.robots.begin(), request.robots.end(), fit)) continue;
    fits = true;
    found = found || port_of(space, robot, request.port) != nullptr;
    for (const hal::PortType* type : space.ports(robot)) {
      if (std::find(ports.begin(), ports.end(), type->catalog_name()) == ports.end())
        ports.push_back(type->catalog_name());
    }
  }
  if (!request.robots.empty() && !fits)
    return hal::Error{"--watch-robots: no robot fits '" + core::listed(request.robots) + "'" +
                      core::did_you_mean(request.robots.front(), names)};
  if (!found)
    return hal::Error{"--watch-port: the controllers of these robots took no port '" + request.port +
                      "'; they took: " + core::listed(ports)};
  return {};
}

Watch::Watch(const WatchRequest& request, const Run& run) : impl_(std::make_unique<Impl>(request, run)) {
  run.watched.add_command("watch",
                          [shared = impl_->shared, sight = run.sight, add_real = run.add_real,
                           eye = std::make_shared<WatchEye>()](const hal::Json&) -> hal::Result<hal::Json> {
                            WatchWish wish;
                            {
                              const std::lock_guard hold(shared->lock);
                              wish = shared->wish;
                            }
                            WatchMoment moment = eye->look(sight(), wish);
                            if (add_real) add_real(moment);
                            const std::lock_guard hold(shared->lock);
                            shared->moment = std::move(moment);
                            return hal::Json::object();
                          });
  if (!Screen::possible()) {
    impl_->thread = std::thread([&impl = *impl_] { impl.work_in_lines(); });
    return;
  }
  impl_->says.emplace([shared = impl_->shared](std::string_view text) {
    const std::lock_guard hold(shared->lock);
    shared->messages.emplace_back(text);
    if (shared->messages.size() > kMostMessages) shared->messages.pop_front();
  });
  catch_suspend_of_screen();
  impl_->screen.emplace();
  impl_->page.keys = impl_->screen->has_keys();
  impl_->thread = std::thread([&impl = *impl_] { impl.work(); });
}

Watch::~Watch() {
  {
    const std::lock_guard hold(impl_->shared->lock);
    impl_->shared->over = true;
    impl_->shared->changed.notify_all();
  }
  impl_->thread.join();
  impl_->screen.reset();
  impl_->says.reset();
  const std::deque<std::string>& all = impl_->shared->messages;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i + kMostLeft >= all.size() || all[i].starts_with("error:")) say(all[i]);
  }
}

}  // namespace tandem::app

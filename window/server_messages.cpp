// What the server says to viewers, and what they ask of the run.
#include <algorithm>
#include <boost/asio/post.hpp>
#include <set>

#include "hal/json/json_access.hpp"
#include "window/server.hpp"
#include "window/viewer.hpp"
#include "window/visitor.hpp"

namespace tandem::window {
namespace {

constexpr std::size_t kLogEntries = 1000;
constexpr int kMostOfViewers = 10, kMostStops = 20;  // a second, of all who have that role

using hal::text_of;

}  // namespace

void Server::tell(Json message) {
  net::post(io, [this, told_message = std::move(message)]() mutable {
    if (!over) told(std::move(told_message));
  });
}

void Server::told(Json message) {
  const std::string type = text_of(message, "type");
  if (type == "inspection") return send_inspection(message);
  if (type == "states") {
    for (const auto& viewer : std::vector(viewers)) {
      if (viewer->state_shown() == text_of(message, "name"))
        viewer->send({shared(hal::to_text(message)), false}, "states");
    }
    return;
  }
  if (type == "state") {
    state = std::move(message);
    return send_state(state);
  }
  if (type == "log") {
    for (const Json& entry : message["entries"]) log.push_back(entry);
    while (log.size() > kLogEntries) log.pop_front();
    for (const auto& viewer : std::vector(viewers)) viewer->send({shared(hal::to_text(message)), false});
    return;
  }
  if (type == "panel") {
    const std::string layer = text_of(message, "layer");
    const auto text = shared(hal::to_text(message));
    for (const auto& viewer : std::vector(viewers)) {
      if (viewer->layers().contains(layer)) viewer->send({text, false}, type + " " + layer);
    }
    return;
  }
  if (type == "hello") {
    layer_names.clear();
    if (const auto layers = message.find("layers"); layers != message.end()) {
      for (const Json& layer : *layers) layer_names.push_back(text_of(layer, "name"));
    }
  }
  send_to_all(message, type);
}

void Server::greet(Viewer& viewer) {
  const auto send = [&](const std::string& type) {
    if (const auto found = last.find(type); found != last.end()) viewer.send({found->second, false}, type);
  };
  send("hello");
  // `look_on` is for a link that an operator hands on.
  const Json role{{"type", "role"}, {"role", name_of(viewer.role())}, {"look_on", viewers_token}};
  viewer.send({shared(hal::to_text(role)), false});
  for (const auto& [type, text] : last) {
    if (type != "hello") send(type);
  }
  if (!log.empty())
    viewer.send(
        {shared(hal::to_text({{"type", "log"}, {"entries", std::vector<Json>(log.begin(), log.end())}})), false});
}

void Server::send_to_all(const Json& message, const std::string& type) {
  const auto text = shared(hal::to_text(message));
  last[type] = text;
  for (const auto& viewer : std::vector(viewers)) viewer->send({text, false}, type);
}

void Server::send_state(const Json& now) {
  Json with_viewers = now;
  with_viewers["viewers"] = viewers.size();
  state_sent = Clock::now();
  send_to_all(with_viewers, "state");
}

void Server::send_inspection(const Json& message) {
  for (const auto& viewer : std::vector(viewers)) {
    if (viewer->inspected().empty()) continue;
    Json theirs = message;
    theirs["robots"] = Json::array();
    for (const Json& robot : message["robots"]) {
      const auto& ids = viewer->inspected();
      if (std::find(ids.begin(), ids.end(), text_of(robot, "id")) != ids.end()) theirs["robots"].push_back(robot);
    }
    viewer->send({shared(hal::to_text(theirs)), false}, "inspection");
  }
}

std::string Server::too_much(UserRole role, const std::string& command) {
  if (role == UserRole::Operator) return {};
  const Clock::time_point now = Clock::now();
  if (now - viewers_second >= std::chrono::seconds(1)) {
    viewers_second = now;
    viewers_said = viewers_stopped = 0;
  }
  // Two budgets, so that nobody can keep others from a stop by asking.
  const bool within = command == "estop" ? ++viewers_stopped <= kMostStops : ++viewers_said <= kMostOfViewers;
  return within ? "" : "viewers have said too much in this second; say it again";
}

void Server::carry_out(Viewer& viewer, const ViewerCommand& command) {
  WindowReply reply = [weak = weak_from_this(), serial = viewer.serial(), id = command.id](const Json& answer) {
    const auto server = weak.lock();
    if (server == nullptr) return;
    net::post(server->io, [server = server.get(), serial, id, answer] {
      for (const auto& asker : std::vector(server->viewers)) {
        if (asker->serial() != serial) continue;
        asker->answered();
        asker->answer(id, answer);
      }
    });
  };
  const std::string why = too_much(viewer.role(), command.name);
  std::function<void(Json, WindowReply)> take;
  std::function<void(const Json&, const Json&)> refused;
  {
    const std::lock_guard lock(mutex);
    take = take_command;
    refused = tell_refused;
  }
  Json whole = command.whole;
  whole["by"] = {{"role", name_of(viewer.role())}, {"address", viewer.address()}};
  if (!may_say(viewer.role(), command.name)) {
    const Json answer = refusal("this address is a viewer's, which sees, and may stop all real robots (estop): '" +
                                command.name + "' needs the address of an operator");
    if (refused && why.empty()) refused(whole, answer);
    return reply(answer);
  }
  if (!why.empty()) return reply(refusal(why));
  if (!take) return reply(refusal("nobody takes commands here"));
  take(std::move(whole), std::move(reply));
}

std::shared_ptr<const std::string> Server::floor_png(const FrameScene& scene) {
  if (floor != scene.floor) {
    floor = scene.floor;
    packed_floor = shared(core::png_of(*floor));
  }
  return packed_floor;
}

bool Server::make_picture(const std::string& name, const std::shared_ptr<Visitor>& visitor) {
  std::function<void(const std::string&, WindowFileReply)> make;
  {
    const std::lock_guard lock(mutex);
    make = picture_maker;
  }
  if (!make) return false;
  const std::uint64_t serial = ++serials;
  waiting_for_picture[serial] = visitor;
  make(name, [weak = weak_from_this(), serial](WindowFile file) {
    const auto server = weak.lock();
    if (server == nullptr) return;
    net::post(server->io, [server = server.get(), serial, file = std::move(file)]() mutable {
      auto waiting = server->waiting_for_picture.extract(serial);
      if (waiting.empty()) return;
      if (file.content.empty())
        return waiting.mapped()->respond(http::status::internal_server_error, "text/plain; charset=utf-8",
                                         shared(file.error + "\n"));
      waiting.mapped()->respond(http::status::ok, file.type, shared(std::move(file.content)));
    });
  });
  return true;
}

void Server::set_wishes() {
  Wishes all;
  std::set<std::string> layers, robots, inspected, states;
  for (const auto& viewer : viewers) {
    layers.insert(viewer->layers().begin(), viewer->layers().end());
    if (!viewer->layers().empty()) {
      robots.insert(viewer->layer_robots().begin(), viewer->layer_robots().end());
      all.all_robots = all.all_robots || viewer->all_robots();
    }
    inspected.insert(viewer->inspected().begin(), viewer->inspected().end());
    if (!viewer->state_shown().empty()) states.insert(viewer->state_shown());
  }
  all.layers.assign(layers.begin(), layers.end());
  all.layer_robots.assign(robots.begin(), robots.end());
  all.inspected.assign(inspected.begin(), inspected.end());
  all.states.assign(states.begin(), states.end());
  const std::lock_guard lock(mutex);
  wishes = std::move(all);
  ++wishes_version;
}

void Server::wished() {
  set_wishes();
  std::function<void()> tell_them;
  {
    const std::lock_guard lock(mutex);
    tell_them = on_wish;
  }
  if (tell_them) tell_them();
}

}  // namespace tandem::window

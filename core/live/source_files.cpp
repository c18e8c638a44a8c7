#include "core/live/source_files.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/live/controls.hpp"
#include "hal/element.hpp"
#include "hal/source_files.hpp"

namespace tandem::core {
namespace {

using hal::Json;

/// Takes the files of a controller, and gives it others.
class Files final : public hal::SourceFilesTaker {
 public:
  explicit Files(const std::map<std::string, std::string>& others) : others_(others) {}

  bool text(std::string_view name, std::string& value, std::string_view help) override {
    (void)SourceFilesTaker::text(name, value, help);
    if (name != hal::kSourceFilesControl || files()->empty()) return false;
    std::vector<hal::SourceFile> wanted = *files();
    for (const auto& other : others_) {
      const auto same = [&](const hal::SourceFile& file) { return file.name == other.first; };
      const auto found = std::find_if(wanted.begin(), wanted.end(), same);
      if (found == wanted.end())
        wanted.push_back({other.first, {}, other.second});
      else
        found->text = other.second;
    }
    std::string changed = hal::packed(wanted);
    if (changed == value) return false;
    value = std::move(changed);
    asked_ = true;
    return true;
  }
  bool asked() const noexcept { return asked_; }

 private:
  const std::map<std::string, std::string>& others_;
  bool asked_ = false;
};

/// Records hold nothing else.
hal::Status check_text(const std::string& name, const Json& text) {
  if (!text.is_string()) return hal::Error{"reload: '" + name + "' is a text"};
  if (hal::is_utf8(text.text())) return {};
  return hal::Error{"'" + name + "' is not UTF-8 text, which records could not keep; save it as UTF-8"};
}

}  // namespace

hal::Result<Json> reload(World& world, Json& command) {
  const auto controller = command.find("controller");
  const auto files = command.find("files");
  if (controller == command.end() || !controller->is_string())
    return hal::Error{"reload: \"controller\" is the id of a configuration"};
  if (files == command.end() || !files->is_object() || files->empty())
    return hal::Error{"reload: \"files\" is an object with a text for each file's name"};
  const auto id = controller->get<std::string>();
  std::map<std::string, std::string> texts;
  for (const auto& [name, text] : files->items()) {
    if (const hal::Status good = check_text(name, text); !good.ok()) return good.error();
    texts[name] = text.get<std::string>();
  }
  const auto& configs = world.scenario().controllers;
  std::vector<std::string> ids;
  for (const ControllerConfig& config : configs) ids.push_back(config.id);
  const auto config = std::find(ids.begin(), ids.end(), id);
  if (config == ids.end()) return hal::Error{"there is no controller '" + id + "'" + hal::did_you_mean(id, ids)};
  const std::vector<RobotId> robots = robots_in_order(world, static_cast<std::size_t>(config - ids.begin()));
  if (robots.empty()) return hal::Error{"no robot has the controller '" + id + "' now"};

  std::size_t begun = 0;
  std::size_t stopped = 0;
  bool any_files = false;
  std::string first_error;
  for (const RobotId robot : robots) {
    Files change(texts);
    const hal::Status done = world.visit_controls(robot, change);
    any_files = any_files || change.files();
    if (!change.asked() && done.ok()) continue;
    if (!done.ok()) {
      if (begun == 0 && stopped == 0) return done.error();
      if (first_error.empty()) first_error = done.error().message;
      ++stopped;
    } else {
      ++begun;
    }
    world.space().set_halted(robot, !done.ok(), HaltOwner::Controller);
  }
  if (!any_files) return hal::Error{"the controller '" + id + "' runs no files that could be read anew"};
  for (const RobotId robot : robots) {
    for (hal::SourceFile& file : source_files(world, robot)) {
      if (const hal::Status good = check_text(file.name, Json(file.text)); good.ok())
        (*files)[file.name] = std::move(file.text);
    }
  }
  Json answer{{"robots", begun}, {"tick", world.tick()}};
  if (stopped > 0) {
    answer["stopped"] = stopped;
    answer["error_of_first"] = first_error;
  }
  return answer;
}

std::vector<RepeatedAction> reloads_to(const Json& recorded, World& world) {
  std::vector<RepeatedAction> all;
  const Json now = source_files(world);
  for (const auto& [id, files] : recorded.items()) {
    const auto present = now.find(id);
    if (present == now.end() || !files.is_array()) continue;
    std::map<std::string, std::string> texts;
    for (const Json& file : *present) texts[file["name"].get<std::string>()] = file["text"].get<std::string>();
    Json wanted = Json::object();
    bool same = true;
    for (const Json& file : files) {
      if (!file.is_object() || !file.contains("name") || !file["name"].is_string() || !file.contains("text")) continue;
      const auto name = file["name"].get<std::string>();
      wanted[name] = file["text"];
      const auto found = texts.find(name);
      same = same && found != texts.end() && file["text"] == found->second;
    }
    if (!same) all.push_back({0, {{"do", "reload"}, {"controller", id}, {"files", std::move(wanted)}}});
  }
  return all;
}

}  // namespace tandem::core

#include "app/window/view_messages.hpp"

#include <memory>

#include "app/build_info.hpp"
#include "app/process/terminal.hpp"
#include "app/run_options.hpp"
#include "app/window/browser.hpp"
#include "core/record/scene_json.hpp"
#include "core/view/render.hpp"

namespace tandem::app {

hal::Result<std::unique_ptr<window::Window>> open_window(const ViewRequest& request) {
  constexpr std::int64_t kLastPort = 65535;
  if (request.port < 0 || request.port > kLastPort)
    return hal::Error{"view: there is no port " + std::to_string(request.port) +
                      "; ports are 0 to 65535, 0 is any that is free"};
  window::WindowOptions options;
  options.address = request.address;
  options.port = static_cast<std::uint16_t>(request.port);
  options.origins = request.origins;
  options.log = hal::Log([](hal::Severity, std::string_view text) { say(text); });
  return window::Window::open(options);
}

void announce(const window::Window& window, const ViewRequest& request) {
  say("view: " + window.address());
  say("view, to look on and to stop real robots alone: " + window.viewers_address());
  if (request.projector) {
    std::string projector = window.address();
    projector.replace(projector.find("/?"), 2, "/projector?");
    say("projector: " + projector);
    if (!request.no_browser) (void)open_browser(projector);
  }
  if (!request.no_browser) (void)open_browser(window.address());
}

std::string action_text(const hal::Json& action) {
  const auto files = action.find("files");
  if (files == action.end() || !files->is_object()) return hal::to_text(action);
  hal::Json shown = action;
  shown["files"] = hal::Json::array();
  for (const auto& [name, text] : files->items()) shown["files"].push_back(name);
  return hal::to_text(shown);
}

hal::Json hello_message(std::string_view experiment, std::string_view mode, std::uint64_t seed,
                        std::int64_t ticks_per_second, const std::vector<std::string>& can,
                        const core::SafetyConfig& safety) {
  return {{"type", "hello"},
          {"protocol", 2},
          {"program", "tandem " + version_text()},
          {"experiment", experiment},
          {"mode", mode},
          {"seed", seed},
          {"ticks_per_second", ticks_per_second},
          {"can", can},
          {"areas", core::areas_json(safety)},
          {"layers", hal::Json::array()},
          {"controls", hal::Json::array()},
          {"kinds", hal::Json::array()},
          {"controllers", hal::Json::array()}};
}

hal::Json LogMessages::entry(hal::Tick tick, std::string_view kind, std::string_view text) {
  constexpr std::string_view kNamed = "robot '";
  hal::Json robot;
  if (const std::size_t at = text.find(kNamed); at != std::string_view::npos) {
    const std::size_t first = at + kNamed.size();
    if (const std::size_t end = text.find('\'', first); end != std::string_view::npos)
      robot = text.substr(first, end - first);
  }
  hal::Json one = {{"n", ++count_}, {"tick", tick}, {"kind", kind}, {"robot", std::move(robot)}, {"text", text}};
  return {{"type", "log"}, {"entries", hal::Json::array({std::move(one)})}};
}

window::WindowFile picture_file(const std::string& name, const std::string& svg) {
  if (name == "picture.svg") return {svg, "image/svg+xml", ""};
  auto png = core::render(svg, core::PictureFormat::Png);
  if (!png.ok()) return {"", "", png.error().message};
  return {std::move(png).value(), "image/png", ""};
}

}  // namespace tandem::app

// Options that several commands have, described once.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/run_options.hpp"
#include "hal/command.hpp"

namespace tandem::app {

/// The option `--plugin`.
void describe_plugins(hal::CommandLine& line, Libraries& plugins);

/// The option `--allow-io`.
void describe_allow_io(hal::CommandLine& line, bool& allow);

/// The option `--step-timeout`.
void describe_step_timeout(hal::CommandLine& line, double& seconds);

/// The option `--hub-fault`, whose text begins with `when`.
void describe_hub_faults(hal::CommandLine& line, std::vector<std::string>& faults, std::string_view when);

/// The option `--desk-keys`.
void describe_desk_keys(hal::CommandLine& line, std::string& keys);

/// The table on the terminal; the option that asks for it has this text.
void describe_watch(hal::CommandLine& line, WatchRequest& request, std::string_view text);

/// Who may look into a window, and where.
void describe_viewers(hal::CommandLine& line, ViewRequest& request);

/// How pictures and films look.
void describe_looks(hal::CommandLine& line, PictureRequest& request);

/// Frames of the film that `option` asks for.
void describe_film(hal::CommandLine& line, std::string_view option, PictureRequest& request);

/// What `run`, `view` and `replay` have in common.
void describe_run(hal::CommandLine& line, RunOptions& options);

/// Options of a run that may serve a page with --view.
struct PagedRunOptions : RunOptions {
  std::optional<std::int64_t> page_port;

  /// The options `--view`, with this text, and `--view-stay`.
  void describe_page(hal::CommandLine& line, std::string_view text);
  /// As `run` takes them.
  RunOptions with_page() const;
};

}  // namespace tandem::app

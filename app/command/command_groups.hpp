// The words of further commands, a file for each group. All add subcommands to `app`; what the chosen one returned is
// put into `code`, which must outlive `app`.
#pragma once

namespace CLI {
class App;
}

namespace tandem::app {

/// `sweep` and `plot` (study_commands.cpp).
void add_study_commands(CLI::App& app, int& code);
/// `fit` and `gap`: the reality gap (gap_commands.cpp).
void add_gap_commands(CLI::App& app, int& code);
/// `calibrate` (calibrate_commands.cpp).
void add_calibrate_commands(CLI::App& app, int& code);

}  // namespace tandem::app

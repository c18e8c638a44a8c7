#include "app/command/validate.hpp"

#include <CLI/CLI.hpp>
#include <memory>

namespace tandem::app {

void add_validate_command(CLI::App& app, int (*does)(const ValidateOptions&), int& code) {
  const auto options = std::make_shared<ValidateOptions>();
  CLI::App* c = app.add_subcommand(
      "validate", "Compare what the program computes with closed forms and references of their own, in one report.");
  c->footer("Exit code: 0 all contracts are met, 4 one is not, 3 the report cannot be made.");
  c->add_option("-o,--out", options->out, "Folder for validation.html, .pdf, .json and figures")->capture_default_str();
  c->add_flag("--short", options->brief, "The short form: less than a minute");
  c->add_option("--only", options->only, "Only these parts: engines, sensors, noise, …")->delimiter(',');
  c->callback([options, does, &code] { code = does(*options); });
}

}  // namespace tandem::app

// `tandem validate`: what it is told. What it does is in the folder validate, which is above this one.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tandem::app {

struct ValidateOptions {
  std::string out = "validation";  ///< folder of the report
  std::vector<std::string> only;   ///< parts by name; empty: all
  bool brief = false;              ///< the short form
};

/// In the folder validate. kDifferent: a contract is not met.
int validate(const ValidateOptions& options);

/// Adds the subcommand to `app`: it calls `does`, and puts what that returned into `code`, which must outlive `app`.
void add_validate_command(CLI::App& app, int (*does)(const ValidateOptions&), int& code);

}  // namespace tandem::app

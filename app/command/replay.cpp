// `tandem replay`: a run with real robots, computed again out of its record.
#include "app/command/command.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {

int replay(RunOptions options) {
  const ReplayRequest& asked = options.replay;
  if (asked.from && asked.until && *asked.until <= *asked.from)
    return complain(kWrongUsage, "--until is to lie behind --from: both are ticks");
  options.repeat = asked.record;
  return run(options);
}

}  // namespace tandem::app

#include "app/command/command.hpp"
#include "app/process/signals.hpp"
#include "app/view/view_record.hpp"

namespace tandem::app {

int view(RunOptions options) {
  options.view.on = options.hold.stay = true;
  if (is_record(options.experiment))
    return view_record(options.experiment, options.view, options.hold, catch_signals());
  if (!options.hold.speed) options.hold.speed = 1.0;
  return run(options);
}

}  // namespace tandem::app

#include "app/command/robot_commands.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "app/process/terminal.hpp"

namespace tandem::app {

void add_step_timeout(CLI::App& command, double& seconds) {
  command
      .add_option("--step-timeout", seconds,
                  "Seconds after which a controller or hook that has not returned is named; Ctrl-C then ends the run; "
                  "0: never")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
}

void add_plugins(CLI::App& command, Libraries& plugins) {
  command
      .add_option("--plugin", plugins,
                  "Library whose parts this call may name: devices, robots, engines, bridges, …; repeatable")
      ->allow_extra_args(false);
}

void add_robot_commands(CLI::App& app, RobotCommandOptions& options, int& code) {
  CLI::App* check_command = app.add_subcommand("check", "Validate an experiment and print every problem.");
  check_command->add_option("experiment", options.check.experiment, "The experiment file (.xml)")->required();
  check_command->add_option("--set", options.check.overrides, "Change the experiment first: path=value")
      ->allow_extra_args(false);
  add_plugins(*check_command, options.check.plugins);
  check_command->callback([&options, &code] { code = check(options.check); });

  CLI::App* robot_command = app.add_subcommand("robot", "Run one real robot's controller here.");
  robot_command->add_option("file", options.robot.file, "Experiment file with one robot that has a <bridge>")
      ->required();
  robot_command->add_option(
      "--link", options.robot.link,
      "Where the robot is, instead of the file's, e.g. serial:/dev/rfcomm0@115200, can:can0, "
      "tcp:ROBOT:33333; peer:tcp:HOST:PORT or peer:serial:…: in lock-step with the simulation there");
  robot_command->add_option("--robot", options.robot.robot,
                            "With peer:…: which robot of that simulation; '*': any that waits; default: the file's");
  robot_command->add_option("--seconds", options.robot.seconds, "How long, instead of the file's length")
      ->check(CLI::PositiveNumber);
  robot_command->add_option("--report", options.robot.report,
                            "Write a JSON report to this file ('-': standard output)");
  add_step_timeout(*robot_command, options.robot.step_timeout_s);
  robot_command
      ->add_option("--hub-fault", options.robot.hub_faults,
                   "A fault of this program, e.g. stall@5s+0.4s, freeze@5s+2s, kill@5s, clock=1h@5s; repeatable")
      ->allow_extra_args(false);
  add_plugins(*robot_command, options.robot.plugins);
  robot_command->callback([&options, &code] {
    code = options.robot.link.starts_with(kPeerScheme) ? robot_peer(options.robot) : robot(options.robot);
  });

  CLI::App* inspect_command =
      app.add_subcommand("inspect", "Say which robot is on a link and what it reads. Moves nothing.");
  inspect_command
      ->add_option("link", options.inspect.link,
                   "e.g. serial:/dev/rfcomm0@115200, can:can0, tcp:ROBOT:33333, lcm:udpm://239.255.76.67:7667?ttl=1")
      ->required();
  inspect_command->add_option("--as", options.inspect.kind,
                              "Kind of robot that is there, where several are reached over such links");
  inspect_command->add_option("--seconds", options.inspect.seconds, "How long to listen")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 3600.0));
  add_plugins(*inspect_command, options.inspect.plugins);
  inspect_command->callback([&options, &code] { code = inspect(options.inspect); });
}

namespace {

/// What is wrong with the command line, and where its words are told.
std::string wrong_usage(const CLI::App& app, const CLI::ParseError& e) {
  std::string command = app.get_name();
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    command += " " + at->get_name();
  }
  std::string what = e.what();
  if (const std::size_t at = what.find(" not in range 0.000000 to 1797"); at != std::string::npos)
    what = what.substr(0, at) + " is too small";  // instead of the 309 digits of the largest number
  if (app.get_subcommands().empty() && !app.remaining().empty())
    what = "there is no command '" + app.remaining().front() + "'";
  return what + "; '" + command + " --help' tells what there is";
}

}  // namespace

int parse_and_run(CLI::App& app, int argc, char** argv, int& code) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error as any other
  try {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0)
      code = complain(kFailedRunning, std::string("standard output: ") + std::strerror(errno));
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    if (argc > 1) return complain(kWrongUsage, wrong_usage(app, e));
    app.exit(e);  // a name alone: all that there is
    return kWrongUsage;
  } catch (const std::bad_alloc&) {
    return complain(kFailedRunning, "out of memory");
  } catch (const std::exception& e) {
    return complain(kFailedRunning, e.what());
  }
  return code;
}

}  // namespace tandem::app

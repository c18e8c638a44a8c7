#include "app/study/slurm.hpp"

#include "app/process/terminal.hpp"
#include "hal/program.hpp"

namespace tandem::app {
namespace {

hal::Result<std::string> submit(std::vector<std::string> arguments) {
  const std::string sbatch = hal::find_program("sbatch");
  if (sbatch.empty()) return can_submit_jobs().error();
  arguments.insert(arguments.begin(), "--parsable");
  auto end = hal::run_program(sbatch, arguments);
  if (!end.ok()) return end.error();
  if (end->code != 0) {
    std::string why = end->errors;
    while (!why.empty() && why.back() == '\n') why.pop_back();
    return hal::Error{"sbatch refused the job: " + (why.empty() ? "it ended with " + std::to_string(end->code) : why)};
  }
  const std::string job = end->output.substr(0, end->output.find_first_of(";\n"));  // "4711" or "4711;cluster"
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos)
    return hal::Error{"sbatch answered '" + end->output.substr(0, 100) + "' and no job's number"};
  return job;
}

}  // namespace

hal::Status can_submit_jobs() {
  if (!hal::find_program("sbatch").empty()) return {};
  return hal::Error{
      "there is no sbatch here: --slurm works on a computer from which a cluster takes jobs (Debian: "
      "slurm-client, and the cluster's slurm.conf). Without --slurm the runs are made here"};
}

hal::Result<std::string> submit_array(const std::string& script, std::size_t elements,
                                      const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"--array=0-" + std::to_string(elements - 1)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.push_back(script);
  return submit(std::move(arguments));
}

hal::Status mark_end_of(const std::string& job, const std::string& mark, const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {"--dependency=afterany:" + job, "--output=/dev/null"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.push_back("--wrap=: >" + shell_word(mark));
  auto submitted = submit(std::move(arguments));
  return submitted.ok() ? hal::Status{} : submitted.error();
}

std::optional<bool> has_job(const std::string& job) {
  const std::string squeue = hal::find_program("squeue");
  if (squeue.empty()) return {};
  auto end = hal::run_program(squeue, {"--noheader", "--format=%i", "--jobs=" + job});
  if (!end.ok()) return {};
  if (end->code == 0) return end->output.find_first_not_of(" \n") != std::string::npos;
  // A job that ended long ago is an error for squeue, as is a controller that does not answer.
  return end->errors.find("Invalid job id") != std::string::npos ? std::optional(false) : std::nullopt;
}

}  // namespace tandem::app

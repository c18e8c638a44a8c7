// A cluster of two nodes on this machine: Slurm's own daemons, with settings, keys and logs in one folder.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <pwd.h>

#include "tests/scenarios/process.hpp"

namespace tandem::study {

/// Ends its daemons with itself. While it lives, sbatch and what it starts find it by SLURM_CONF.
class Cluster {
 public:
  Cluster() {
    namespace fs = std::filesystem;
    for (const char* name : {"state", "munge"}) fs::create_directory(file(name));
    fs::permissions(file("munge"), fs::perms::owner_all);
    std::ofstream(file("munge/key"), std::ios::binary) << std::string(1024, 'k');
    fs::permissions(file("munge/key"), fs::perms::owner_read);
    write_settings();
    setenv("SLURM_CONF", file("slurm.conf").c_str(), 1);
    start({"munged", "--foreground", "--force", "--num-threads=2", "--key-file=" + file("munge/key"),
           "--socket=" + file("munge/socket"), "--pid-file=" + file("munge/pid"), "--log-file=" + file("munge/log"),
           "--seed-file=" + file("munge/seed")});
    const bool keys = scenarios::eventually([this] { return std::filesystem::exists(file("munge/socket")); }, 20.0);
    EXPECT_TRUE(keys) << log();
    start({"slurmctld", "-D", "-f", file("slurm.conf")});
    for (const char* node : {"n1", "n2"}) start({"slurmd", "-D", "-N", node, "-f", file("slurm.conf")});
  }
  ~Cluster() {
    for (const pid_t daemon : daemons_) kill(daemon, SIGKILL);
    for (const pid_t daemon : daemons_) waitpid(daemon, nullptr, 0);
    for (const char* word : {"--batch-number", "batch.sh", "slurmstepd", "slurm_script"}) {
      for (const pid_t process : processes_with(word)) kill(process, SIGKILL);
    }
    unsetenv("SLURM_CONF");
  }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  std::string log() const {
    std::string all;
    for (const char* name : {"munge/log", "daemons", "slurmctld.log", "slurmd-n1.log", "slurmd-n2.log"})
      all += scenarios::text_of(file(name));
    return all;
  }

  /// Processes of this cluster whose command line has this word.
  std::vector<pid_t> processes_with(const std::string& word) const {
    std::vector<pid_t> found;
    for (const pid_t process : scenarios::processes_marked(file("slurm.conf"))) {
      const std::string line = scenarios::text_of("/proc/" + std::to_string(process) + "/cmdline");
      if (process != getpid() && line.find(word) != std::string::npos) found.push_back(process);
    }
    return found;
  }

 private:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  void write_settings() const {
    char host[256] = {};
    gethostname(host, sizeof host - 1);
    const std::string name = std::string(host).substr(0, std::string(host).find('.'));
    const passwd* const me = getpwuid(getuid());
    const std::string user = me != nullptr ? me->pw_name : "root";
    const int port = 20'000 + 4 * (getpid() % 2'000);  // its own, where several clusters run
    const std::string ports = std::to_string(port + 1) + "-" + std::to_string(port + 2);
    std::ofstream(file("slurm.conf"))
        << "ClusterName=test\nSlurmctldHost=" << name << "(127.0.0.1)\nSlurmctldPort=" << port << "\nSlurmUser=" << user
        << "\nSlurmdUser=" << user << "\nAuthType=auth/munge\nAuthInfo=socket=" << file("munge/socket")
        << ",cred_expire=5"
        << "\nStateSaveLocation=" << file("state") << "\nSlurmdSpoolDir=" << file("spool-%n")
        << "\nSlurmctldPidFile=" << file("slurmctld.pid") << "\nSlurmdPidFile=" << file("slurmd-%n.pid")
        << "\nSlurmctldLogFile=" << file("slurmctld.log") << "\nSlurmdLogFile=" << file("slurmd-%n.log")
        << "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres"
        << "\nSelectTypeParameters=CR_CPU\nSlurmdParameters=config_overrides\nCommunicationParameters=NoInAddrAny"
        << "\nReturnToService=2\nSlurmdTimeout=300\nMpiDefault=none\nJobAcctGatherType=jobacct_gather/none"
        << "\nSchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0"
        << "\nNodeName=n[1-2] NodeHostname=" << name << " NodeAddr=127.0.0.1 Port=" << ports << " CPUs=1"
        << "\nPartitionName=all Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP\n";
  }

  void start(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string said = file("daemons");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, said.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    pid_t daemon = -1;
    const int failed = posix_spawnp(&daemon, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    EXPECT_EQ(failed, 0) << words[0] << " cannot be started; Debian: slurm-wlm";
    if (failed == 0) daemons_.push_back(daemon);
  }

  scenarios::Folder folder_;
  std::vector<pid_t> daemons_;
};

}  // namespace tandem::study

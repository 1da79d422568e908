// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// TARGET CORPUS: runs a fuzz target, without libFuzzer, on all files of a folder and on mutations
// of them, for a bounded number of inputs: the same in each run. Exit code 0 if none made it crash,
// hang or grow; else the input is kept in a file, and its name printed.
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/mutation.hpp"

namespace swiftlet::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestInput = 1 << 16;
/// Of the processor, so that a busy machine does not count. Most inputs take microseconds.
constexpr int kHangSeconds = 5;
constexpr double kMostGrowth = 64.0;  // [MB]
constexpr auto kShortForm = std::chrono::seconds(3);
constexpr auto kLongForm = std::chrono::seconds(60);
constexpr int kShortInputs = 20'000;
constexpr int kLongInputs = 1'000'000;

// For the signal handler.
Bytes current;
char kept[] = "fuzz-input-XXXXXX";

/// Only what may be called in a handler.
extern "C" void keep_input(int signal) {
  const int file = mkstemp(kept);
  if (file >= 0 && write(file, current.data(), current.size()) >= 0) close(file);
  const char* reason = signal == SIGPROF ? "hangs on the input in " : "crashes on the input in ";
  for (const char* text : {reason, static_cast<const char*>(kept), "\n"}) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(2);
  }
  _exit(1);
}

void set_limit(int seconds) {
  itimerval limit{};
  limit.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &limit, nullptr);
}

void run(const Bytes& input) {
  current = input;
  set_limit(kHangSeconds);
  // A copy of its own size, so that the address sanitizer sees who reads behind it.
  const Bytes exact(input.begin(), input.end());
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
  set_limit(0);
}

std::vector<Bytes> read_corpus(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry);
  std::sort(files.begin(), files.end());  // the same order everywhere
  std::vector<Bytes> corpus;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return corpus;
}

/// Resident memory [MB].
double memory() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

int fuzz(const std::vector<Bytes>& corpus) {
  const char* full = std::getenv("SWIFTLET_FULL_TESTS");
  const bool is_long = full != nullptr && std::strcmp(full, "1") == 0;
  const auto end = Clock::now() + (is_long ? kLongForm : kShortForm);
  const int count = is_long ? kLongInputs : kShortInputs;

  for (const Bytes& input : corpus) run(input);
  std::mt19937 random(1);
  double before = 0.0;
  int done = 0;
  for (; done < count && Clock::now() < end; ++done) {
    // What is kept for good, such as the largest object of each type, is there by then.
    if (done == count / 10) before = memory();
    const Bytes& seed = corpus[random() % corpus.size()];
    const Bytes& other = corpus[random() % corpus.size()];
    run(mutated(seed, other, kLargestInput, random));
  }
  const double after = memory();
  std::printf("%zu files, %d mutations, %.1f MB, then %.1f MB\n", corpus.size(), done, before,
              after);
#if !defined(__SANITIZE_ADDRESS__)  // which keeps what is freed for a while
  if (before > 0.0 && after - before > kMostGrowth) {
    std::fprintf(stderr, "grew by %.1f MB\n", after - before);
    return 1;
  }
#endif
  return 0;
}

}  // namespace
}  // namespace swiftlet::fuzz

int main(int argc, char** argv) {
  using namespace swiftlet::fuzz;
  if (argc != 2) {
    std::fprintf(stderr, "wanted: the folder with the corpus\n");
    return 2;
  }
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGPROF}) {
    std::signal(signal, keep_input);
  }
  const auto corpus = read_corpus(argv[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s is empty\n", argv[1]);
    return 2;
  }
  return fuzz(corpus);
}

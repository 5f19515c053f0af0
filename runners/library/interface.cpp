// The functions of zerocount.h.

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <future>
#include <memory>
#include <new>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <zerocount/zerocount.h>

#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/library/description.hpp"
#include "runners/library/job.hpp"

struct zerocount_study {
  zerocount::study::Study study;
};

struct zerocount_job {
  std::stop_source stop;
  zerocount::library::Result result;
  std::vector<zerocount_array> arrays;
  std::shared_future<void> done;  // its end waits for the work, which uses the others
};

namespace zerocount::library {
namespace {

thread_local std::string message;

std::int32_t failed(ExitCode code, std::string text) {
  message = std::move(text);
  return static_cast<std::int32_t>(code);
}

/// Runs the work of a function of the C interface. An exception does not leave it: it becomes the exit code
/// and the message of the last error.
template <class Work>
std::int32_t guarded(const Work& work) {
  try {
    work();
    return 0;
  } catch (const Failure& failure) {
    return failed(failure.code(), failure.what());
  } catch (const trial::Interrupted&) {
    return failed(ExitCode::interrupted, "stopped");
  } catch (const std::bad_alloc&) {
    return failed(ExitCode::machine_failed, "out of memory");
  } catch (const std::exception& error) {
    return failed(ExitCode::machine_failed, error.what());
  }
}

std::vector<std::string> texts_of(const char* const* texts, std::size_t count) {
  return {texts, texts + count};
}

/// Copy of a text on the heap for the C interface, which zerocount_free_text() frees.
char* copy_of(const std::string& text) {
  char* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) throw std::bad_alloc();
  std::memcpy(copy, text.c_str(), text.size() + 1);
  return copy;
}

/// Starts a job that runs `work` on a thread of its own.
template <class Work>
std::unique_ptr<zerocount_job> started(Work work) {
  auto job = std::make_unique<zerocount_job>();
  job->done = std::async(std::launch::async, [it = job.get(), work = std::move(work)] {
                it->result = work(it->stop.get_token());
                it->arrays = it->result.arrays();
              }).share();
  return job;
}

void require_trial(const study::Study& study, std::int64_t trial) {
  if (trial < 0 || trial >= study.trials)
    throw Failure(ExitCode::bad_input, fmt::format("{}: trial = {} is out of range; expected 0 to {}",
                                                   study.name, trial, study.trials - 1));
}

}  // namespace
}  // namespace zerocount::library

using namespace zerocount::library;  // NOLINT(google-build-using-namespace): for what C calls

extern "C" {

std::uint32_t zerocount_abi_version() {
  return ZEROCOUNT_ABI;
}

const char* zerocount_version() {
  return ZEROCOUNT_VERSION;
}

const char* zerocount_message() {
  return message.c_str();
}

std::int32_t zerocount_read_study(const char* text, std::size_t size, const char* source, const char* folder,
                                  const char* const* overrides, std::size_t override_count,
                                  zerocount_study** study) {
  return guarded([&] {
    *study =
        new zerocount_study{study_of_text({text, size}, source, folder, texts_of(overrides, override_count))};
  });
}

std::int32_t zerocount_open_study(const char* file, zerocount_study** study) {
  return guarded([&] { *study = new zerocount_study{study_of_file(file)}; });
}

std::int32_t zerocount_study_under(const zerocount_study* study, const char* condition,
                                   zerocount_study** under) {
  namespace study_of = zerocount::study;
  return guarded([&] {
    *under = new zerocount_study{
        study_of::in_setting(study->study, study_of::setting_labelled(study->study, condition))};
  });
}

void zerocount_free_study(zerocount_study* study) {
  delete study;
}

std::int32_t zerocount_describe_study(const zerocount_study* study, char** json) {
  return guarded([&] { *json = copy_of(description_of(study->study)); });
}

std::int32_t zerocount_describe_variables(const zerocount_study* study, std::int64_t point, char** json) {
  return guarded([&] { *json = copy_of(variables_of(study->study, point)); });
}

std::int32_t zerocount_describe_manifest(const char* text, std::size_t size, const char* source,
                                         const char* const* overrides, std::size_t override_count,
                                         char** json) {
  return guarded([&] {
    *json = copy_of(manifest_of({text, size}, source, texts_of(overrides, override_count)));
  });
}

void zerocount_free_text(char* text) {
  std::free(text);
}

std::int32_t zerocount_values_at_scores(const zerocount_study* study, std::int64_t point, std::int64_t trials,
                                        double* values) {
  namespace randomness = zerocount::randomness;
  return guarded([&] {
    const randomness::RandomVariables variables = sampled_variables(study->study, point);
    for (std::int64_t trial = 0; trial < trials; ++trial) {
      for (const randomness::RandomVariable& variable : variables.variables) {
        const double u = randomness::uniform_of_score(*values);
        *values++ = zerocount::distributions::quantile(variable.distribution, u);
      }
    }
  });
}

std::int32_t zerocount_start_outcomes(const zerocount_study* study, std::int64_t point, std::int64_t trials,
                                      const double* values, const std::int64_t* numbers, std::int32_t threads,
                                      zerocount_job** job) {
  return guarded([&] {
    const std::size_t width = sampled_variables(study->study, point).variables.size();
    const auto count = static_cast<std::size_t>(trials);
    *job = started([=](const std::stop_token& stop) {
             return simulated(study->study, point, {values, count * width}, {numbers, count}, threads, stop);
           }).release();
  });
}

std::int32_t zerocount_start_trial(const zerocount_study* study, std::int64_t point, std::int64_t trial,
                                   zerocount_law* law, zerocount_job** job) {
  return guarded([&] {
    require_point(study->study, point);
    require_trial(study->study, trial);
    if (law == nullptr) {
      *job = started([=](const std::stop_token& stop) {
               return traced(study->study, point, trial, nullptr, stop);
             }).release();
      return;
    }
    auto finished = std::make_unique<zerocount_job>();
    finished->result = traced(study->study, point, trial, law, {});
    finished->arrays = finished->result.arrays();
    std::promise<void> done;
    done.set_value();
    finished->done = done.get_future().share();
    *job = finished.release();
  });
}

std::int32_t zerocount_wait(zerocount_job* job, std::int32_t milliseconds, std::int32_t* done) {
  return guarded([&] {
    const std::chrono::milliseconds time{milliseconds};
    *done = job->done.wait_for(time) == std::future_status::ready ? 1 : 0;
    if (*done == 1) job->done.get();
  });
}

const zerocount_array* zerocount_result(const zerocount_job* job, std::size_t* count) {
  *count = job->arrays.size();
  return job->arrays.data();
}

void zerocount_free_job(zerocount_job* job) {
  if (job != nullptr) job->stop.request_stop();
  delete job;
}

}  // extern "C"

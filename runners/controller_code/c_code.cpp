#include "runners/controller_code/c_code.hpp"

#include <cmath>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "core/loop/controller/cascade.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/controller/disturbance_observer.hpp"
#include "core/loop/controller/filter.hpp"
#include "core/loop/controller/pid.hpp"
#include "core/loop/controller/torque_hold.hpp"
#include "core/loop/dac.hpp"

namespace zerocount::controller_code {
namespace {

/// The number, exactly, as a C99 constant.
std::string number(double value) {
  return fmt::format("{:a}", value);
}

/// The parts of the file that depend on the blocks in use.
struct Parts {
  std::string state;   ///< members of the struct
  std::string start;   ///< statements
  std::string memory;  ///< statements of each sample, before the chain
  std::string held;    ///< statements where the torque is held
  std::string chain;   ///< statements that compute u

  void add_state(const std::string& name, const std::string& comment, double initial = 0.0) {
    state += fmt::format("  double {}; /* {} */\n", name, comment);
    start += fmt::format("  s->{} = {};\n", name, number(initial));
  }
};

struct Writing {
  const ControllerToWrite& of;
  const loop::ControlBlocks& blocks;
  double sample_rate;
  bool cascade;
  Parts parts{};

  bool has_standstill() const { return blocks.standstill.band >= 0.0 && !cascade; }
  bool has_hold() const { return blocks.hold.enter >= 0.0; }
};

/// e′, and the count differences.
void write_error(Writing& w) {
  const loop::ErrorDeadbandConstants<double> zone = loop::error_deadband_constants(w.blocks.error_deadband);
  w.parts.memory += "  double e = error; /* counts */\n";
  if (zone.band > 0.0) {
    w.parts.memory += fmt::format("  if (magnitude(error) <= {0}) e = 0.0;\n", number(zone.band));
    if (zone.subtracted > 0.0)
      w.parts.memory +=
          fmt::format("  else e = error > 0.0 ? error - {0} : error + {0};\n", number(zone.subtracted));
  }
  w.parts.add_state("count", "at the last sample, counts");
  w.parts.add_state("difference", "of successive counts, filtered, counts");
  const double pole = loop::derivative_pole(w.blocks, w.sample_rate);
  w.parts.chain += "    const double change = in->count - s->count;\n";
  w.parts.chain += pole == 0.0
                       ? std::string("    s->difference = change;\n")
                       : fmt::format("    s->difference = {} * s->difference + (1.0 - {}) * change;\n",
                                     number(pole), number(pole));
}

/// I ← clamp(ρ·I + increment), under its conditions.
void write_integral(Writing& w) {
  const loop::TorqueRange range = loop::integral_range(
      w.of.controller.anti_windup, loop::lowest_torque(w.of.dac), loop::highest_torque(w.of.dac));
  const loop::IntegralConstants<double> c = loop::integral_constants(w.blocks, w.sample_rate, range);
  w.parts.add_state("integral", "I, N m", w.of.initial_integral);
  std::string condition;
  if (c.enter >= 0.0) {
    w.parts.add_state("inside", "the error is within the deadband: 0 or 1");
    w.parts.chain +=
        fmt::format("    s->inside = magnitude(error) <= (s->inside != 0.0 ? {} : {}) ? 1.0 : 0.0;\n",
                    number(c.leave), number(c.enter));
    condition = "s->inside == 0.0";
  }
  if (std::isfinite(c.zone))
    condition += fmt::format("{}magnitude(error) <= {}", condition.empty() ? "" : " && ", number(c.zone));
  std::string changed = c.retention == 1.0 ? std::string("s->integral + increment")
                                           : fmt::format("{} * s->integral + increment", number(c.retention));
  if (std::isfinite(c.lowest))
    changed = fmt::format("limited({}, {}, {})", changed, number(c.lowest), number(c.highest));
  w.parts.chain += condition.empty() ? fmt::format("    s->integral = {};\n", changed)
                                     : fmt::format("    if ({}) s->integral = {};\n", condition, changed);
}

void write_pid(Writing& w) {
  const loop::ControllerParameters& c = w.of.controller;
  w.parts.add_state("error", "e' of the last sample, counts");
  const auto gain = [&](double usual, double at_standstill) {
    return w.has_standstill() ? fmt::format("(stands ? {} : {})", number(at_standstill), number(usual))
                              : number(usual);
  };
  const loop::Standstill& still = w.blocks.standstill;
  if (w.has_standstill()) {
    w.parts.add_state("still", "samples for which the error has been within the band of standstill");
    w.parts.memory += fmt::format(
        "  if (in->new_target) s->still = 0.0;\n"
        "  s->still = magnitude(error) <= {} ? s->still + 1.0 : 0.0;\n"
        "  const int stands = s->still >= {} && !in->new_target;\n",
        number(still.band), number(loop::dwell_samples(still.dwell, w.sample_rate)));
  }
  w.parts.chain += fmt::format("    const double increment = {} * (e + s->error);\n", gain(c.ki, still.ki));
  write_integral(w);
  w.parts.chain += fmt::format("    u = s->integral + {} * e - {} * s->difference;\n", gain(c.kp, still.kp),
                               gain(c.kd, still.kd));
  w.parts.chain += "    s->error = e;\n";
  w.parts.held += "    s->error = e;\n";
}

void write_cascade(Writing& w) {
  const loop::CascadeConstants<double> c =
      loop::cascade_constants(w.blocks.cascade, w.sample_rate, w.of.resolution);
  w.parts.add_state("velocity_error", "of the last sample, rad/s");
  const std::string now = fmt::format("{} * e - {} * s->difference", number(c.kv), number(c.velocity));
  w.parts.chain += fmt::format("    const double velocity_error = {};\n", now);
  w.parts.chain +=
      fmt::format("    const double increment = {} * (velocity_error + s->velocity_error);\n", number(c.ki));
  write_integral(w);
  w.parts.chain += fmt::format("    u = {} * velocity_error + s->integral;\n", number(c.kp));
  w.parts.chain += "    s->velocity_error = velocity_error;\n";
  w.parts.held += fmt::format("    s->velocity_error = {};\n", now);
}

void write_filters(Writing& w) {
  for (std::size_t i = 0; i < w.blocks.filters.size(); ++i) {
    const loop::BiquadConstants<double> c = loop::discretised(w.blocks.filters[i], w.sample_rate);
    const std::string a = fmt::format("filter{}a", i);
    const std::string b = fmt::format("filter{}b", i);
    w.parts.add_state(a, "N m");
    w.parts.add_state(b, "N m");
    w.parts.chain += fmt::format(
        "    {{\n"
        "      const double x = u;\n"
        "      u = {b0} * x + s->{a};\n"
        "      s->{a} = {b1} * x - {a1} * u + s->{b};\n"
        "      s->{b} = {b2} * x - {a2} * u;\n"
        "    }}\n",
        fmt::arg("b0", number(c.b0)), fmt::arg("b1", number(c.b1)), fmt::arg("b2", number(c.b2)),
        fmt::arg("a1", number(c.a1)), fmt::arg("a2", number(c.a2)), fmt::arg("a", a), fmt::arg("b", b));
  }
}

void write_feedforward(Writing& w) {
  const auto& [velocity, acceleration, friction] = w.blocks.feedforward;
  if (velocity == 0.0 && acceleration == 0.0 && friction == 0.0) return;
  w.parts.chain +=
      fmt::format("    u = u + ({} * in->velocity + {} * in->acceleration + {} * sign(in->velocity));\n",
                  number(velocity), number(acceleration), number(friction));
}

void write_observer(Writing& w) {
  if (!(w.blocks.observer.bandwidth > 0.0)) return;
  const loop::ObserverConstants<double> c =
      loop::observer_constants(w.blocks.observer, w.sample_rate, w.of.resolution);
  w.parts.add_state("first_count", "counts");
  w.parts.add_state("observer_a", "N m");
  w.parts.add_state("observer_b", "N m");
  w.parts.memory += "  if (!s->started) s->first_count = in->count;\n";
  w.parts.chain += fmt::format(
      "    {{\n"
      "      const double inertia = {} * (in->count - s->first_count);\n"
      "      const double filtered = {} * in->torque;\n"
      "      const double estimate = inertia - filtered + s->observer_a;\n"
      "      s->observer_a = -2.0 * (inertia + filtered) - {} * estimate + s->observer_b;\n"
      "      s->observer_b = inertia - filtered - {} * estimate;\n"
      "      u = u - estimate;\n"
      "    }}\n",
      number(c.acceleration), number(c.q), number(c.a1), number(c.a2));
}

void write_hold(Writing& w) {
  if (!w.has_hold()) return;
  const loop::HoldConstants<double> c = loop::hold_constants(w.blocks.hold, w.sample_rate);
  w.parts.add_state("within", "samples for which the error has been within the hold");
  w.parts.add_state("holding", "0 or 1");
  w.parts.add_state("torque", "wanted at the last sample, N m");
  w.parts.memory += fmt::format(
      "  const int fresh = in->new_target || !s->started;\n"
      "  if (fresh) s->within = 0.0;\n"
      "  s->within = magnitude(error) <= {} ? s->within + 1.0 : 0.0;\n"
      "  s->holding = !fresh && (s->within >= {} || (s->holding != 0.0 && magnitude(error) <= {}));\n",
      number(c.enter), number(c.dwell), number(c.leave));
}

std::string dither_statement(const loop::ControllerParameters& c) {
  if (c.dither.amplitude == 0.0) return {};
  return fmt::format("  u = u + ((int64_t)(2.0 * {} * (double)s->sample / {}) % 2 == 0 ? {} : -{});\n",
                     number(c.dither.frequency), number(c.sample_rate), number(c.dither.amplitude),
                     number(c.dither.amplitude));
}

/// What a reader of the file needs to know.
std::string heading(const Writing& w) {
  return fmt::format(
      "/* The controller of the study {}, as zerocount simulates it.\n"
      " *\n"
      " * One step at each sample, {:.17g} Hz. Counts are those of an encoder of {:.9g} rad (m) a count; "
      "torques\n"
      " * (forces) are in N m (N). The converter behind it rounds the torque to its steps of {:.9g} N m (N) "
      "and\n"
      " * limits it; give `torque`, what it gave at the sample before, back to the next step.\n"
      " * The constants are exact, and the operations in the order of the simulation: compiled without\n"
      " * -ffast-math and with -ffp-contract=off it computes the same bits. */\n",
      boost::algorithm::replace_all_copy(w.of.name, "*/", "* /"), w.sample_rate, w.of.resolution,
      w.of.dac.resolution);
}

constexpr const char* helpers = R"(
typedef struct {
  double error;        /* the reference, rounded to counts, less the count */
  double count;        /* of the encoder, counts */
  double velocity;     /* of the reference, rad/s */
  double acceleration; /* of the reference, rad/s^2 */
  double torque;       /* that the converter gave at the sample before, N m; 0 at the first */
  int new_target;      /* the target is not that of the sample before */
} controller_input;

static inline double magnitude(double x) { return x < 0.0 ? -x : x; }
static inline double limited(double x, double lowest, double highest) {
  const double above = x < lowest ? lowest : x;
  return highest < above ? highest : above;
}
static inline double sign(double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }
)";

constexpr const char* plugin = R"(
#ifdef ZEROCOUNT_PLUGIN
#include <zerocount/controller.h>

static int plugin_start(void* state, const zerocount_setup* setup, char* message, size_t size) {
  (void)setup, (void)message, (void)size;
  controller_start(state);
  return 0;
}
static double plugin_step(void* state, const zerocount_setup* setup, const zerocount_sample* now) {
  const controller_input in = {now->error,        now->count,  now->velocity,
                               now->acceleration, now->torque, now->new_target};
  (void)setup;
  return controller_step(state, &in);
}
static const zerocount_controller description = {
    sizeof description, ZEROCOUNT_CONTROLLER_ABI, "exported", "1", 0, 0, sizeof(controller_state),
    plugin_start,       plugin_step};
const zerocount_controller* zerocount_controller_entry(void) { return &description; }
#endif
)";

/// The chain without the plugin.
std::string chain_code(const ControllerToWrite& chain) {
  const loop::ControllerParameters& c = chain.controller;
  Writing w{chain, c.blocks, c.sample_rate, c.blocks.structure == loop::ControlStructure::cascade};
  write_error(w);
  w.cascade ? write_cascade(w) : write_pid(w);
  write_filters(w);
  write_feedforward(w);
  write_observer(w);
  write_hold(w);
  const bool dithers = c.dither.amplitude != 0.0;
  std::string code = heading(w);
  code += "#include <stdint.h>\n";
  code += helpers;
  code += "\ntypedef struct {\n" + w.parts.state;
  if (dithers) code += "  int64_t sample; /* number of the next one */\n";
  code += "  int started; /* there has been a sample */\n} controller_state;\n";
  code += "\n/* Before the first sample. */\nvoid controller_start(controller_state* s) {\n" + w.parts.start;
  if (dithers) code += "  s->sample = 0;\n";
  code += "  s->started = 0;\n}\n";
  code += "\n/* The wanted torque (N m) at this sample. */\n";
  code += "double controller_step(controller_state* s, const controller_input* in) {\n";
  code += "  const double error = in->error; /* counts */\n  double u;\n";
  code += "  if (!s->started) s->count = in->count;\n";
  code += w.parts.memory;
  if (w.has_hold()) {
    code += "  if (s->holding != 0.0) {\n" + w.parts.held + "    u = s->torque;\n  } else {\n" +
            w.parts.chain + "    s->torque = u;\n  }\n";
  } else {
    code += "  {\n" + w.parts.chain + "  }\n";
  }
  code += "  s->count = in->count;\n  s->started = 1;\n";
  code += dither_statement(c);
  if (dithers) code += "  s->sample += 1;\n";
  code += "  return u;\n}\n";
  return code;
}

constexpr const char* linuxcnc_head = R"comp(component {} "Position controller, as zerocount simulates it";
pin in bit enable "without it the torque is 0, and the controller starts anew";
pin in float target-counts "end of the move, counts";
pin in float command-counts "reference, which is rounded to counts";
pin in float feedback-counts "of the encoder, counts";
pin in float command-velocity "of the reference, rad/s (m/s)";
pin in float command-acceleration "of the reference, rad/s2 (m/s2)";
pin out float output-torque "wanted torque, N m (N)";
function _ fp "one sample";
option data component_data;
license "GPL";
;;
)comp";

constexpr const char* linuxcnc_function = R"comp(
typedef struct {{
  controller_state chain;
  double given;  /* by the converter at the sample before, N m */
  double target; /* at the sample before, counts */
  int runs;
}} component_data;

static double nearest(double x) {{ return (x + 0x1.8p52) - 0x1.8p52; }}

FUNCTION(_) {{
  component_data* memory = &data;
  if (!enable) {{
    memory->runs = 0;
    output_torque = 0.0;
    return;
  }}
  if (!memory->runs) {{
    controller_start(&memory->chain);
    memory->given = 0.0;
    memory->target = target_counts;
    memory->runs = 1;
  }}
  const controller_input in = {{nearest(command_counts) - feedback_counts, feedback_counts, command_velocity,
                               command_acceleration, memory->given, memory->target != target_counts}};
  const double wanted = controller_step(&memory->chain, &in);
  memory->target = target_counts;
  memory->given = limited({resolution} * nearest(wanted / {resolution}), {lowest}, {highest});
  output_torque = wanted;
}}
)comp";

}  // namespace

std::string_view why_not_writable(const loop::ControllerParameters& controller) {
  if (controller.user.plugin) return "the controller is a plugin, whose code is its own";
  if (loop::has_coarse_phase(controller)) return "a control with two phases cannot be written yet";
  return {};
}

std::string c_code(const ControllerToWrite& chain) {
  return chain_code(chain) + plugin;
}

std::string linuxcnc_component(const ControllerToWrite& chain, const std::string& component) {
  const loop::DacParameters& dac = chain.dac;
  return fmt::format(linuxcnc_head, component) + chain_code(chain) +
         fmt::format(linuxcnc_function, fmt::arg("resolution", number(dac.resolution)),
                     fmt::arg("lowest", number(loop::lowest_torque(dac))),
                     fmt::arg("highest", number(loop::highest_torque(dac))));
}

}  // namespace zerocount::controller_code

#include "sim/compute/instruction_set.h"

#include <array>
#include <string>

namespace fude {
namespace {

constexpr std::array<std::string_view, 3> names{"sse2", "avx2", "avx512"};

}  // namespace

std::string_view name_of(InstructionSet set) { return names[static_cast<std::size_t>(set)]; }

std::optional<InstructionSet> instruction_set_named(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<InstructionSet>(i);
  return std::nullopt;
}

bool processor_has(InstructionSet set) {
  __builtin_cpu_init();
  switch (set) {
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::sse2:
      break;
  }
  return true;
}

InstructionSet widest_instruction_set() {
  if (processor_has(InstructionSet::avx512)) return InstructionSet::avx512;
  return processor_has(InstructionSet::avx2) ? InstructionSet::avx2 : InstructionSet::sse2;
}

Result<InstructionSet> choose_instruction_set(std::optional<InstructionSet> wanted) {
  const InstructionSet set = wanted.value_or(widest_instruction_set());
  if (processor_has(set)) return set;
  return failure(Fault::unsupported, "this processor has no " + std::string(name_of(set)) + "; use --isa " +
                                         std::string(name_of(widest_instruction_set())));
}

}  // namespace fude

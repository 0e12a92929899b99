// Which vector instructions a kernel was compiled for. Every set gives the same bits; wider is faster.
#pragma once

#include <optional>
#include <string_view>

#include "signal/result.h"

namespace fude {

enum class InstructionSet { sse2, avx2, avx512 };

std::string_view name_of(InstructionSet set);

// "sse2", "avx2", "avx512"; nothing for any other word.
std::optional<InstructionSet> instruction_set_named(std::string_view name);

bool processor_has(InstructionSet set);

// The widest set this processor has.
InstructionSet widest_instruction_set();

// The wanted set, or the widest where none is wanted. Fault::unsupported where the processor lacks it.
Result<InstructionSet> choose_instruction_set(std::optional<InstructionSet> wanted);

}  // namespace fude

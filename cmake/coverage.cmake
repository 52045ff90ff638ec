# Target coverage_report: what the tests run so far have not reached in the kernel, and pages that show it, in
# <build>/coverage. Their profiles are in <build>/profiles.
find_program(LLVM_PROFDATA llvm-profdata REQUIRED)
find_program(LLVM_COV llvm-cov REQUIRED)
get_property(programs DIRECTORY tests PROPERTY BUILDSYSTEM_TARGETS)
list(FILTER programs INCLUDE REGEX "^test_")
list(REMOVE_ITEM programs test_support)
list(TRANSFORM programs REPLACE ".+" "$<TARGET_FILE:\\0>" OUTPUT_VARIABLE files)
list(TRANSFORM files PREPEND "-object;" OUTPUT_VARIABLE objects)
add_custom_target(coverage_report
  COMMAND ${LLVM_PROFDATA} merge -sparse profiles -o all.profdata
  COMMAND ${LLVM_COV} show -format=html -output-dir=coverage -instr-profile all.profdata $<TARGET_FILE:slideway>
    ${objects} ${PROJECT_SOURCE_DIR}/kernel
  COMMAND ${PROJECT_SOURCE_DIR}/tests/coverage/report ${LLVM_COV} all.profdata $<TARGET_FILE:slideway> ${files}
  WORKING_DIRECTORY ${PROJECT_BINARY_DIR} COMMAND_EXPAND_LISTS VERBATIM USES_TERMINAL)

# Fuzz targets: fuzz/fuzz_NAME.c, each with two drivers.
#
#   fuzz_NAME_smoke   by fuzz/random.c, any compiler; a ctest with label fuzz-smoke, a fixed number of runs
#   fuzz_NAME         by libFuzzer, where the compiler has it; built by tools/fuzz alone (target mctau_fuzz)
#
# Whatever the preset, core and HAL are compiled once more with the sanitizers.
option(MCTAU_BUILD_FUZZ "Build the fuzz targets' smoke runs" ON)
set(fuzz_sanitize -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer)
file(GLOB fuzz_targets CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz_*.c)

# Runs of each target: some five seconds on a slow core.
set(fuzz_runs_can_drive 6000)
set(fuzz_runs_can_host 4000)
set(fuzz_runs_candump 100000)
set(fuzz_runs_codec 20000)
set(fuzz_runs_command 1000)
set(fuzz_runs_log 3000)
set(fuzz_runs_scene 100000)

# --- what the compiler can do ---

include(CheckCSourceCompiles)
include(CMakePushCheckState)
# Whether a program compiles and links.
function(mctau_fuzz_flags_work variable source)
    cmake_push_check_state(RESET)
    set(CMAKE_REQUIRED_FLAGS "${ARGN}")
    set(CMAKE_REQUIRED_LINK_OPTIONS ${ARGN})
    string(REPLACE ";" " " CMAKE_REQUIRED_FLAGS "${CMAKE_REQUIRED_FLAGS}")
    check_c_source_compiles("${source}" ${variable})
    cmake_pop_check_state()
endfunction()
mctau_fuzz_flags_work(MCTAU_HAVE_FUZZ_SANITIZERS "int main(void) { return 0; }" ${fuzz_sanitize})
mctau_fuzz_flags_work(MCTAU_HAVE_LIBFUZZER
    "#include <stddef.h>\n#include <stdint.h>\nint LLVMFuzzerTestOneInput(const uint8_t *d, size_t n);
     int LLVMFuzzerTestOneInput(const uint8_t *d, size_t n) { return d == NULL && n > 0; }"
    -fsanitize=fuzzer ${fuzz_sanitize})

# --- the targets ---

set(fuzz_sources ${MCTAU_CORE_SOURCES} ${MCTAU_HAL_SOURCES} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/can_scenes.c)
list(GET MCTAU_PRECISIONS 0 fuzz_precision)
mctau_names(${fuzz_precision})

# The command's own sources, of one precision; those of its targets are in the command's folder (fuzz/command.c).
find_path(CSV_INCLUDE_DIR csv.h)
find_library(CSV_LIBRARY csv)
mark_as_advanced(CSV_INCLUDE_DIR CSV_LIBRARY)
set(fuzz_of_command command log)
file(GLOB fuzz_command_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/mctau/*.c)
set_source_files_properties(${fuzz_command_sources} PROPERTIES
    COMPILE_OPTIONS "-w;-include;${CMAKE_CURRENT_SOURCE_DIR}/fuzz/command_inside.h")
set_source_files_properties(${PROJECT_SOURCE_DIR}/tools/mctau/runner.c PROPERTIES
    COMPILE_DEFINITIONS "runner_try=fuzz_try;runner_drive=fuzz_drive;hard_run_case=fuzz_hard_case")
list(APPEND fuzz_command_sources ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/command.c ${hard_sources})
string(TOUPPER ${tag} TAG)

# What targets share, with a way to learn what was reached.
function(mctau_fuzz_library name sources)
    add_library(${name} STATIC EXCLUDE_FROM_ALL ${sources})
    target_compile_options(${name} PRIVATE -O1 ${fuzz_sanitize} ${ARGN})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}
        ${PROJECT_BINARY_DIR}/include/${fuzz_precision} ${PROJECT_SOURCE_DIR}/src ${CMAKE_CURRENT_SOURCE_DIR})
endfunction()

# NAME: core and HAL. NAME_command: the command, on top of them.
function(mctau_fuzz_core name)
    mctau_fuzz_library(${name} "${fuzz_sources}" ${ARGN})
    target_compile_definitions(${name} PRIVATE _POSIX_C_SOURCE=200809L MCTAU_HAVE_LCM=${MCTAU_HAVE_LCM}
        MCT_OUTLINE)
    target_link_libraries(${name} PUBLIC ${library})
    if(CSV_INCLUDE_DIR AND CSV_LIBRARY)
        mctau_fuzz_library(${name}_command "${fuzz_command_sources}" ${ARGN})
        target_compile_definitions(${name}_command PRIVATE _GNU_SOURCE MCT_HAVE_${TAG}=1
            MCT_RUNNER=mct_runner_${tag} MCT_SOURCE="${PROJECT_SOURCE_DIR}")
        target_include_directories(${name}_command PUBLIC ${PROJECT_SOURCE_DIR}/tools/mctau)
        target_include_directories(${name}_command SYSTEM PRIVATE ${CSV_INCLUDE_DIR})
        target_link_libraries(${name}_command PUBLIC ${name} ${CSV_LIBRARY})
    endif()
endfunction()

function(mctau_fuzz_program name core driver)
    add_executable(${name} ${ARGN})
    target_compile_options(${name} PRIVATE ${MCTAU_TEST_WARNINGS} -O1 ${fuzz_sanitize})
    target_link_options(${name} PRIVATE ${fuzz_sanitize})
    target_link_libraries(${name} PRIVATE ${core} ${driver} ${MCTAU_MATH_LIBRARY})
endfunction()

set(fuzz_skipped "")
if(NOT MCTAU_BUILD_FUZZ)
    set(fuzz_skipped "MCTAU_BUILD_FUZZ is off")
elseif(NOT MCTAU_HAVE_FUZZ_SANITIZERS)
    set(fuzz_skipped "this compiler, or preset, cannot link the address sanitizer")
elseif(MCTAU_SANITIZE MATCHES "thread")
    set(fuzz_skipped "the thread sanitizer goes with no other")
endif()

if(NOT fuzz_skipped)
    set(trace -fsanitize-coverage=trace-pc)
    mctau_fuzz_core(mctau_fuzz_core ${trace})
    # Apart from the rest, for what learns what was reached must not be asked itself.
    add_library(mctau_fuzz_random OBJECT ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/random.c)
    target_compile_options(mctau_fuzz_random PRIVATE ${MCTAU_TEST_WARNINGS} -O2)
    target_link_libraries(mctau_fuzz_random PRIVATE mctau_fuzz_core)
    add_custom_target(mctau_fuzz_smoke)
endif()
if(MCTAU_HAVE_LIBFUZZER AND NOT fuzz_skipped)
    mctau_fuzz_core(mctau_fuzz_core_libfuzzer -fsanitize=fuzzer-no-link)
    add_custom_target(mctau_fuzz)
endif()

foreach(file IN LISTS fuzz_targets)
    get_filename_component(name ${file} NAME_WE)
    string(REGEX REPLACE "^fuzz_" "fuzz_runs_" runs ${name})
    string(REGEX REPLACE "^fuzz_" "" target ${name})
    set(core "")
    set(skipped "${fuzz_skipped}")
    if(target IN_LIST fuzz_of_command)
        set(core _command)
        if(NOT CSV_INCLUDE_DIR OR NOT CSV_LIBRARY)
            set(skipped "libcsv not found")
        endif()
    endif()
    if(skipped)
        mctau_skipped_test(${name} ${file} "${skipped}")
        continue()
    endif()
    mctau_fuzz_program(${name}_smoke mctau_fuzz_core${core} mctau_fuzz_random ${file})
    target_compile_options(${name}_smoke PRIVATE ${trace})
    add_dependencies(mctau_fuzz_smoke ${name}_smoke)
    add_test(NAME ${name} COMMAND ${name}_smoke --runs ${${runs}})
    mctau_test_properties(${name} ${file})
    if(TARGET mctau_fuzz)
        mctau_fuzz_program(${name} mctau_fuzz_core_libfuzzer${core} "" ${file} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/libfuzzer.c)
        target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
        target_link_options(${name} PRIVATE -fsanitize=fuzzer)
        set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
        add_dependencies(mctau_fuzz ${name})
    endif()
endforeach()

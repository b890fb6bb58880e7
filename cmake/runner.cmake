# The command, with every precision in one binary.
#
# The core has the same C names in each precision, so two of them cannot be linked into one program as such.
# What belongs to a precision (tools/mctau/runner*.c, tools/hard, core, HAL, telemetry types) is therefore linked into one
# object file first, and every name in it but one, MCT_RUNNER, is made local to that file:
#
#   runner*.c, core, hal  --ld -r-->  all_f32.o  --objcopy-->  runner_f32.o, which shows mct_runner_f32 alone
#
# The front end, tools/mctau without runner*.c, is linked with the first precision's library and with these
# objects. It learns from MCT_HAVE_F64 and MCT_HAVE_F32 which runners there are.
file(GLOB_RECURSE command_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/mctau/*.c)
set(runner_sources ${command_sources})
list(FILTER runner_sources INCLUDE REGEX "/runner[^/]*\\.c$")
list(FILTER command_sources EXCLUDE REGEX "/runner[^/]*\\.c$")
file(GLOB hard_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/hard/*.c) # belong to a precision as well
set_source_files_properties(${hard_sources} PROPERTIES COMPILE_OPTIONS -Wno-double-promotion) # references in long double
if(NOT command_sources)
    mctau_missing("tools/mctau holds no C file, so the command is left out")
    return()
endif()

find_path(CSV_INCLUDE_DIR csv.h)
find_library(CSV_LIBRARY csv)
mark_as_advanced(CSV_INCLUDE_DIR CSV_LIBRARY)
if(NOT CSV_INCLUDE_DIR OR NOT CSV_LIBRARY)
    message(FATAL_ERROR "mctau: libcsv not found (tools/setup installs it); the command reads CSV with it")
endif()

list(GET MCTAU_PRECISIONS 0 precision)
mctau_names(${precision})
add_executable(mctau_command ${command_sources})
target_link_libraries(mctau_command PRIVATE ${library})

foreach(precision IN LISTS MCTAU_PRECISIONS)
    mctau_names(${precision})
    if(NOT runner_sources)
        break()
    endif()
    add_library(mctau_runner_${tag} OBJECT ${runner_sources} ${hard_sources})
    target_link_libraries(mctau_runner_${tag} PRIVATE ${library})
    target_compile_definitions(mctau_runner_${tag} PRIVATE MCT_RUNNER=mct_runner_${tag})

    set(objects $<TARGET_OBJECTS:mctau_runner_${tag}> $<TARGET_OBJECTS:mctau_core_${tag}>)
    if(TARGET mctau_hal_${tag})
        list(APPEND objects $<TARGET_OBJECTS:mctau_hal_${tag}>)
    endif()
    if(MCTAU_HAVE_LCM)
        get_target_property(kind mctau_lcm_types TYPE)
        if(kind STREQUAL "STATIC_LIBRARY")
            list(APPEND objects $<TARGET_OBJECTS:mctau_lcm_types>)
        endif()
    endif()

    set(all ${PROJECT_BINARY_DIR}/runner/all_${tag}.o)
    set(runner ${PROJECT_BINARY_DIR}/runner/runner_${tag}.o)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/runner)
    add_custom_command(OUTPUT ${runner}
        COMMAND ${CMAKE_C_COMPILER} -r -nostdlib -o ${all} ${objects}
        COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=mct_runner_${tag} ${all} ${runner}
        COMMAND ${CMAKE_COMMAND} -E rm ${all}
        DEPENDS ${objects} COMMENT "Runner ${tag}" COMMAND_EXPAND_LISTS VERBATIM)
    set_source_files_properties(${runner} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
    target_sources(mctau_command PRIVATE ${runner})
    add_dependencies(mctau_command mctau_runner_${tag} ${library}) # make sees no other target's files
    string(TOUPPER ${tag} TAG)
    target_compile_definitions(mctau_command PRIVATE MCT_HAVE_${TAG}=1)
endforeach()

foreach(target mctau_command mctau_runner_f64 mctau_runner_f32)
    if(TARGET ${target})
        target_compile_options(${target} PRIVATE ${MCTAU_WARNINGS})
        target_compile_definitions(${target} PRIVATE _POSIX_C_SOURCE=200809L)
        target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tools/mctau)
        target_include_directories(${target} SYSTEM PRIVATE ${CSV_INCLUDE_DIR})
    endif()
endforeach()
target_link_libraries(mctau_command PRIVATE ${CSV_LIBRARY} ${MCTAU_MATH_LIBRARY})
target_compile_definitions(mctau_command PRIVATE MCT_SOURCE="${PROJECT_SOURCE_DIR}") # where what draws is found
set_target_properties(mctau_command PROPERTIES OUTPUT_NAME mctau)

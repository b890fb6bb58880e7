# Which C tests of src/ run on an emulated Cortex-M too: float on the M4F, double on the M7. For tests/CMakeLists.txt,
# which names them to ctest, and for the CMakeLists.txt beside this file, which builds them for the target.
set(units_kinds m4f m7)
set(units_tags f32 f64)

# mctau_units(LIST TAG): the files, in the caller's LIST. Left out by what they hold:
#   hal/socketcan   they need an operating system
#   quad.h, and what includes it: the reference is in quadruple precision, which is double here, and enough to judge float,
#                   unless the test says that it is not (return 77)
# And by name:
set(units_too_long # for an emulator: each takes more than ten seconds
    test_chain_kinematics test_friction_benchmarks test_invariants_property test_pace test_zero_coefficient)
set(units_not_f32 ${units_too_long} test_taylor) # this one as well
set(units_not_f64 ${units_too_long} test_friction_modes_f64) # its reference is in long double, which is double here

get_filename_component(units_tests ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)

function(mctau_units list tag)
    if(tag STREQUAL f64)
        set(other f32)
        set(needs "hal/socketcan|support/(quad|reference|bodies|textbook)\\.h")
    else()
        set(other f64)
        set(needs "hal/socketcan|return 77")
    endif()
    set(found)
    foreach(room math gauss effects systems steppers control loop scene)
        file(GLOB files CONFIGURE_DEPENDS ${units_tests}/${room}/test_*.c)
        foreach(file IN LISTS files)
            get_filename_component(name ${file} NAME_WE)
            file(STRINGS ${file} lacking REGEX "${needs}" LIMIT_COUNT 1)
            if(NOT lacking AND NOT name MATCHES "_${other}$" AND NOT name IN_LIST units_not_${tag})
                list(APPEND found ${file})
            endif()
        endforeach()
    endforeach()
    set(${list} ${found} PARENT_SCOPE)
endfunction()

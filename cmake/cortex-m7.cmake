# Cortex-M7 with both precisions in hardware.
set(MCTAU_CORTEX_M_FLAGS "-mcpu=cortex-m7 -mfpu=fpv5-d16")
include(${CMAKE_CURRENT_LIST_DIR}/cortex-m.cmake)

#include "mctau/status.h"

const char *mct_status_text(mct_status status)
{
    switch (status) {
#define MCT_STATUS_CASE(name, number, text) \
    case name:                              \
        return text;
        MCT_STATUS_LIST(MCT_STATUS_CASE)
#undef MCT_STATUS_CASE
    }
    return "this number is not a status";
}

#include "hal/socketcan/transport.h"

#include "hal/socketcan/filter.h"

const char *mct_can_link_text(mct_can_link_state state)
{
    static const char *const texts[MCT_CAN_LINK_STATES] = {
        [MCT_CAN_UP] = "the bus is up",
        [MCT_CAN_DOWN] = "the CAN interface is down: set it up again ('ip link set ... up')",
        [MCT_CAN_GONE] = "the CAN interface is not there any more: plug the adapter in again and set it up",
        [MCT_CAN_BUS_OFF] =
            ("the CAN controller has left the bus after too many errors: look at wiring, termination "
             "and bit rate; it comes back by itself where restart-ms is set, else by 'ip link set "
             "... type can restart'"),
        [MCT_CAN_UNSENT] =
            ("a command waits to be sent because nobody acknowledges it: look at the drive's supply, "
             "the wiring and the bit rate"),
        [MCT_CAN_END_OF_LOG] = "the recorded log has come to its end",
    };
    return (unsigned)state < MCT_CAN_LINK_STATES ? texts[state] : "not a state of a link";
}

bool mct_can_check_filters(const mct_can_filter *filters, int count, mct_message *why)
{
    if (count < 0 || count > MCT_CAN_MAX_FILTERS) {
        mct_message_add(why, "found ");
        mct_message_add_integer(why, count);
        mct_message_add(why, " identifiers to listen to; allowed up to ");
        mct_message_add_integer(why, MCT_CAN_MAX_FILTERS);
        return false;
    }
    for (int i = 0; i < count; i++) {
        const uint32_t largest = filters[i].extended ? 0x1FFFFFFF : 0x7FF;
        if (filters[i].id > largest) {
            mct_message_add(why, "found identifier ");
            mct_message_add_integer(why, filters[i].id);
            mct_message_add(why, " to listen to; allowed up to ");
            mct_message_add_integer(why, largest);
            return false;
        }
    }
    return true;
}

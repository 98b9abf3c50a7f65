"""Messages of ublox_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import (
    DEFAULT,
    Array,
    Bytes,
    Ints,
    Message,
    Sequence,
    char,
    float32,
    float64,
    int8,
    int16,
    int32,
    uint8,
    uint16,
    uint32,
)

__all__ = [
    "Ack",
    "AidALM",
    "AidEPH",
    "AidHUI",
    "CfgANT",
    "CfgCFG",
    "CfgDAT",
    "CfgDGNSS",
    "CfgGNSS",
    "CfgGNSSBlock",
    "CfgHNR",
    "CfgINF",
    "CfgINFBlock",
    "CfgMSG",
    "CfgNAV5",
    "CfgNAVX5",
    "CfgNMEA",
    "CfgNMEA6",
    "CfgNMEA7",
    "CfgPRT",
    "CfgRATE",
    "CfgRST",
    "CfgSBAS",
    "CfgTMODE3",
    "CfgUSB",
    "CfgVALDEL",
    "CfgVALGET",
    "CfgVALSET",
    "CfgVALSETCfgdata",
    "EsfINS",
    "EsfMEAS",
    "EsfRAW",
    "EsfRAWBlock",
    "EsfSTATUS",
    "EsfSTATUSSens",
    "HnrPVT",
    "Inf",
    "MgaGAL",
    "MonGNSS",
    "MonHW",
    "MonHW6",
    "MonVER",
    "MonVERExtension",
    "NavATT",
    "NavCLOCK",
    "NavCOV",
    "NavDGPS",
    "NavDGPSSV",
    "NavDOP",
    "NavPOSECEF",
    "NavPOSLLH",
    "NavPVT",
    "NavPVT7",
    "NavRELPOSNED",
    "NavRELPOSNED9",
    "NavSAT",
    "NavSATSV",
    "NavSBAS",
    "NavSBASSV",
    "NavSOL",
    "NavSTATUS",
    "NavSVIN",
    "NavSVINFO",
    "NavSVINFOSV",
    "NavTIMEGPS",
    "NavTIMEUTC",
    "NavVELECEF",
    "NavVELNED",
    "RxmALM",
    "RxmEPH",
    "RxmRAW",
    "RxmRAWSV",
    "RxmRAWX",
    "RxmRAWXMeas",
    "RxmRTCM",
    "RxmSFRB",
    "RxmSFRBX",
    "RxmSVSI",
    "RxmSVSISV",
    "TimTM2",
    "UpdSOS",
    "UpdSOSAck",
]


class Ack(Message, typename="ublox_msgs/msg/Ack"):
    """Ack, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 5
    NACK_MESSAGE_ID: ClassVar[uint8] = 0
    ACK_MESSAGE_ID: ClassVar[uint8] = 1

    cls_id: uint8 = 0
    msg_id: uint8 = 0


class AidALM(Message, typename="ublox_msgs/msg/AidALM"):
    """AidALM, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 11
    MESSAGE_ID: ClassVar[uint8] = 48

    svid: uint32 = 0
    week: uint32 = 0
    dwrd: Annotated[Ints, Sequence[uint32]] = DEFAULT


class AidEPH(Message, typename="ublox_msgs/msg/AidEPH"):
    """AidEPH, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 11
    MESSAGE_ID: ClassVar[uint8] = 49

    svid: uint32 = 0
    how: uint32 = 0
    sf1d: Annotated[Ints, Sequence[uint32]] = DEFAULT
    sf2d: Annotated[Ints, Sequence[uint32]] = DEFAULT
    sf3d: Annotated[Ints, Sequence[uint32]] = DEFAULT


class AidHUI(Message, typename="ublox_msgs/msg/AidHUI"):
    """AidHUI, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 11
    MESSAGE_ID: ClassVar[uint8] = 2
    FLAGS_HEALTH: ClassVar[uint32] = 1
    FLAGS_UTC: ClassVar[uint32] = 2
    FLAGS_KLOB: ClassVar[uint32] = 4

    health: uint32 = 0
    utc_a0: float64 = 0.0
    utc_a1: float64 = 0.0
    utc_tow: int32 = 0
    utc_wnt: int16 = 0
    utc_ls: int16 = 0
    utc_wnf: int16 = 0
    utc_dn: int16 = 0
    utc_lsf: int16 = 0
    utc_spare: int16 = 0
    klob_a0: float32 = 0.0
    klob_a1: float32 = 0.0
    klob_a2: float32 = 0.0
    klob_a3: float32 = 0.0
    klob_b0: float32 = 0.0
    klob_b1: float32 = 0.0
    klob_b2: float32 = 0.0
    klob_b3: float32 = 0.0
    flags: uint32 = 0


class CfgANT(Message, typename="ublox_msgs/msg/CfgANT"):
    """CfgANT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 19
    FLAGS_SVCS: ClassVar[uint16] = 1
    FLAGS_SCD: ClassVar[uint16] = 2
    FLAGS_OCD: ClassVar[uint16] = 4
    FLAGS_PDWN_ON_SCD: ClassVar[uint16] = 8
    FLAGS_RECOVERY: ClassVar[uint16] = 16
    PIN_SWITCH_MASK: ClassVar[uint16] = 31
    PIN_SCD_MASK: ClassVar[uint16] = 992
    PIN_OCD_MASK: ClassVar[uint16] = 31744
    PIN_RECONFIG: ClassVar[uint16] = 32678

    flags: uint16 = 0
    pins: uint16 = 0


class CfgCFG(Message, typename="ublox_msgs/msg/CfgCFG"):
    """CfgCFG, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 9
    MASK_IO_PORT: ClassVar[uint32] = 1
    MASK_MSG_CONF: ClassVar[uint32] = 2
    MASK_INF_MSG: ClassVar[uint32] = 4
    MASK_NAV_CONF: ClassVar[uint32] = 8
    MASK_RXM_CONF: ClassVar[uint32] = 16
    MASK_SEN_CONF: ClassVar[uint32] = 256
    MASK_RINV_CONF: ClassVar[uint32] = 512
    MASK_ANT_CONF: ClassVar[uint32] = 1024
    MASK_LOG_CONF: ClassVar[uint32] = 2048
    MASK_FTS_CONF: ClassVar[uint32] = 4096
    DEV_BBR: ClassVar[uint8] = 1
    DEV_FLASH: ClassVar[uint8] = 2
    DEV_EEPROM: ClassVar[uint8] = 4
    DEV_SPI_FLASH: ClassVar[uint8] = 16

    clear_mask: uint32 = 0
    save_mask: uint32 = 0
    load_mask: uint32 = 0
    device_mask: uint8 = 0


class CfgDAT(Message, typename="ublox_msgs/msg/CfgDAT"):
    """CfgDAT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 6
    DATUM_NUM_WGS84: ClassVar[uint16] = 0
    DATUM_NUM_USER: ClassVar[uint16] = 65535

    datum_num: uint16 = 0
    datum_name: Annotated[Ints, Array[uint8, 6]] = DEFAULT
    maj_a: float64 = 0.0
    flat: float64 = 0.0
    d_x: float32 = 0.0
    d_y: float32 = 0.0
    d_z: float32 = 0.0
    rot_x: float32 = 0.0
    rot_y: float32 = 0.0
    rot_z: float32 = 0.0
    scale: float32 = 0.0


class CfgDGNSS(Message, typename="ublox_msgs/msg/CfgDGNSS"):
    """CfgDGNSS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 112
    DGNSS_MODE_RTK_FLOAT: ClassVar[uint8] = 2
    DGNSS_MODE_RTK_FIXED: ClassVar[uint8] = 3

    dgnss_mode: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 3]] = DEFAULT


class CfgGNSSBlock(Message, typename="ublox_msgs/msg/CfgGNSSBlock"):
    """CfgGNSSBlock, as ublox defines it."""

    GNSS_ID_GPS: ClassVar[uint8] = 0
    GNSS_ID_SBAS: ClassVar[uint8] = 1
    GNSS_ID_GALILEO: ClassVar[uint8] = 2
    GNSS_ID_BEIDOU: ClassVar[uint8] = 3
    GNSS_ID_IMES: ClassVar[uint8] = 4
    GNSS_ID_QZSS: ClassVar[uint8] = 5
    GNSS_ID_GLONASS: ClassVar[uint8] = 6
    RES_TRK_CH_GPS: ClassVar[uint8] = 8
    RES_TRK_CH_QZSS: ClassVar[uint8] = 0
    RES_TRK_CH_SBAS: ClassVar[uint8] = 0
    RES_TRK_CH_GLONASS: ClassVar[uint8] = 8
    MAX_TRK_CH_MAJOR_MIN: ClassVar[uint8] = 4
    MAX_TRK_CH_GPS: ClassVar[uint8] = 16
    MAX_TRK_CH_GLONASS: ClassVar[uint8] = 14
    MAX_TRK_CH_QZSS: ClassVar[uint8] = 3
    MAX_TRK_CH_SBAS: ClassVar[uint8] = 3
    FLAGS_ENABLE: ClassVar[uint32] = 1
    FLAGS_SIG_CFG_MASK: ClassVar[uint32] = 16711680
    SIG_CFG_GPS_L1CA: ClassVar[uint32] = 65536
    SIG_CFG_SBAS_L1CA: ClassVar[uint32] = 65536
    SIG_CFG_GALILEO_E1OS: ClassVar[uint32] = 65536
    SIG_CFG_BEIDOU_B1I: ClassVar[uint32] = 65536
    SIG_CFG_IMES_L1: ClassVar[uint32] = 65536
    SIG_CFG_QZSS_L1CA: ClassVar[uint32] = 65536
    SIG_CFG_QZSS_L1SAIF: ClassVar[uint32] = 262144
    SIG_CFG_GLONASS_L1OF: ClassVar[uint32] = 65536

    gnss_id: uint8 = 0
    res_trk_ch: uint8 = 0
    max_trk_ch: uint8 = 0
    reserved1: uint8 = 0
    flags: uint32 = 0


class CfgGNSS(Message, typename="ublox_msgs/msg/CfgGNSS"):
    """CfgGNSS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 62

    msg_ver: uint8 = 0
    num_trk_ch_hw: uint8 = 0
    num_trk_ch_use: uint8 = 0
    num_config_blocks: uint8 = 0
    blocks: Annotated[list[CfgGNSSBlock], Sequence[CfgGNSSBlock]] = DEFAULT


class CfgHNR(Message, typename="ublox_msgs/msg/CfgHNR"):
    """CfgHNR, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 92

    high_nav_rate: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 3]] = DEFAULT


class CfgINFBlock(Message, typename="ublox_msgs/msg/CfgINFBlock"):
    """CfgINFBlock, as ublox defines it."""

    PROTOCOL_ID_UBX: ClassVar[uint8] = 0
    PROTOCOL_ID_NMEA: ClassVar[uint8] = 1
    INF_MSG_ERROR: ClassVar[uint8] = 1
    INF_MSG_WARNING: ClassVar[uint8] = 2
    INF_MSG_NOTICE: ClassVar[uint8] = 4
    INF_MSG_TEST: ClassVar[uint8] = 8
    INF_MSG_DEBUG: ClassVar[uint8] = 16

    protocol_id: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    inf_msg_mask: Annotated[Ints, Array[uint8, 6]] = DEFAULT


class CfgINF(Message, typename="ublox_msgs/msg/CfgINF"):
    """CfgINF, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 2

    blocks: Annotated[list[CfgINFBlock], Sequence[CfgINFBlock]] = DEFAULT


class CfgMSG(Message, typename="ublox_msgs/msg/CfgMSG"):
    """CfgMSG, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 1

    msg_class: uint8 = 0
    msg_id: uint8 = 0
    rate: uint8 = 0


class CfgNAV5(Message, typename="ublox_msgs/msg/CfgNAV5"):
    """CfgNAV5, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 36
    MASK_DYN: ClassVar[uint16] = 1
    MASK_MIN_EL: ClassVar[uint16] = 2
    MASK_FIX_MODE: ClassVar[uint16] = 4
    MASK_DR_LIM: ClassVar[uint16] = 8
    MASK_POS_MASK: ClassVar[uint16] = 16
    MASK_TIME_MASK: ClassVar[uint16] = 32
    MASK_STATIC_HOLD_MASK: ClassVar[uint16] = 64
    MASK_DGPS_MASK: ClassVar[uint16] = 128
    MASK_CNO: ClassVar[uint16] = 256
    MASK_UTC: ClassVar[uint16] = 1024
    DYN_MODEL_PORTABLE: ClassVar[uint8] = 0
    DYN_MODEL_STATIONARY: ClassVar[uint8] = 2
    DYN_MODEL_PEDESTRIAN: ClassVar[uint8] = 3
    DYN_MODEL_AUTOMOTIVE: ClassVar[uint8] = 4
    DYN_MODEL_SEA: ClassVar[uint8] = 5
    DYN_MODEL_AIRBORNE_1G: ClassVar[uint8] = 6
    DYN_MODEL_AIRBORNE_2G: ClassVar[uint8] = 7
    DYN_MODEL_AIRBORNE_4G: ClassVar[uint8] = 8
    DYN_MODEL_WRIST_WATCH: ClassVar[uint8] = 9
    FIX_MODE_2D_ONLY: ClassVar[uint8] = 1
    FIX_MODE_3D_ONLY: ClassVar[uint8] = 2
    FIX_MODE_AUTO: ClassVar[uint8] = 3
    UTC_STANDARD_AUTOMATIC: ClassVar[uint8] = 0
    UTC_STANDARD_GPS: ClassVar[uint8] = 3
    UTC_STANDARD_GLONASS: ClassVar[uint8] = 6
    UTC_STANDARD_BEIDOU: ClassVar[uint8] = 7

    mask: uint16 = 0
    dyn_model: uint8 = 0
    fix_mode: uint8 = 0
    fixed_alt: int32 = 0
    fixed_alt_var: uint32 = 0
    min_elev: int8 = 0
    dr_limit: uint8 = 0
    p_dop: uint16 = 0
    t_dop: uint16 = 0
    p_acc: uint16 = 0
    t_acc: uint16 = 0
    static_hold_thresh: uint8 = 0
    dgnss_time_out: uint8 = 0
    cno_thresh_num_svs: uint8 = 0
    cno_thresh: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    static_hold_max_dist: uint16 = 0
    utc_standard: uint8 = 0
    reserved2: Annotated[Ints, Array[uint8, 5]] = DEFAULT


class CfgNAVX5(Message, typename="ublox_msgs/msg/CfgNAVX5"):
    """CfgNAVX5, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 35
    MASK1_MIN_MAX: ClassVar[uint16] = 4
    MASK1_MIN_CNO: ClassVar[uint16] = 8
    MASK1_INITIAL_FIX_3D: ClassVar[uint16] = 64
    MASK1_WKN_ROLL: ClassVar[uint16] = 512
    MASK1_ACK_AID: ClassVar[uint16] = 1024
    MASK1_PPP: ClassVar[uint16] = 8192
    MASK1_AOP: ClassVar[uint16] = 16384
    MASK2_ADR: ClassVar[uint32] = 64
    MASK2_SIG_ATTEN_COMP_MODE: ClassVar[uint32] = 128

    version: uint16 = 0
    mask1: uint16 = 0
    mask2: uint32 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    min_svs: uint8 = 0
    max_svs: uint8 = 0
    min_cno: uint8 = 0
    reserved2: uint8 = 0
    ini_fix3d: uint8 = 0
    reserved3: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    ack_aiding: uint8 = 0
    wkn_rollover: uint16 = 0
    sig_atten_comp_mode: uint8 = 0
    reserved4: Annotated[Ints, Array[uint8, 5]] = DEFAULT
    use_ppp: uint8 = 0
    aop_cfg: uint8 = 0
    reserved5: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    aop_orb_max_err: uint16 = 0
    reserved6: Annotated[Ints, Array[uint8, 7]] = DEFAULT
    use_adr: uint8 = 0


class CfgNMEA(Message, typename="ublox_msgs/msg/CfgNMEA"):
    """CfgNMEA, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 23
    FILTER_POS: ClassVar[uint8] = 1
    FILTER_MSK_POS: ClassVar[uint8] = 2
    FILTER_TIME: ClassVar[uint8] = 4
    FILTER_DATE: ClassVar[uint8] = 8
    FILTER_GPS_ONLY: ClassVar[uint8] = 16
    FILTER_TRACK: ClassVar[uint8] = 32
    NMEA_VERSION_4_1: ClassVar[uint8] = 65
    NMEA_VERSION_4_0: ClassVar[uint8] = 64
    NMEA_VERSION_2_3: ClassVar[uint8] = 35
    NMEA_VERSION_2_1: ClassVar[uint8] = 33
    NUM_SV_UNLIMITED: ClassVar[uint8] = 0
    FLAGS_COMPAT: ClassVar[uint8] = 1
    FLAGS_CONSIDER: ClassVar[uint8] = 2
    FLAGS_LIMIT82: ClassVar[uint8] = 4
    FLAGS_HIGH_PREC: ClassVar[uint8] = 8
    GNSS_TO_FILTER_GPS: ClassVar[uint32] = 1
    GNSS_TO_FILTER_SBAS: ClassVar[uint32] = 2
    GNSS_TO_FILTER_QZSS: ClassVar[uint32] = 16
    GNSS_TO_FILTER_GLONASS: ClassVar[uint32] = 32
    GNSS_TO_FILTER_BEIDOU: ClassVar[uint32] = 64
    SV_NUMBERING_STRICT: ClassVar[uint8] = 0
    SV_NUMBERING_EXTENDED: ClassVar[uint8] = 1
    MAIN_TALKER_ID_NOT_OVERRIDDEN: ClassVar[uint8] = 0
    MAIN_TALKER_ID_GP: ClassVar[uint8] = 1
    MAIN_TALKER_ID_GL: ClassVar[uint8] = 2
    MAIN_TALKER_ID_GN: ClassVar[uint8] = 3
    MAIN_TALKER_ID_GA: ClassVar[uint8] = 4
    MAIN_TALKER_ID_GB: ClassVar[uint8] = 5
    GSV_TALKER_ID_GNSS_SPECIFIC: ClassVar[uint8] = 0
    GSV_TALKER_ID_MAIN: ClassVar[uint8] = 1
    VERSION: ClassVar[uint8] = 1

    filter: uint8 = 0
    nmea_version: uint8 = 0
    num_sv: uint8 = 0
    flags: uint8 = 0
    gnss_to_filter: uint32 = 0
    sv_numbering: uint8 = 0
    main_talker_id: uint8 = 0
    gsv_talker_id: uint8 = 0
    version: uint8 = 0
    bds_talker_id: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    reserved1: Annotated[Ints, Array[uint8, 6]] = DEFAULT


class CfgNMEA6(Message, typename="ublox_msgs/msg/CfgNMEA6"):
    """CfgNMEA6, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 23
    FILTER_POS: ClassVar[uint8] = 1
    FILTER_MSK_POS: ClassVar[uint8] = 2
    FILTER_TIME: ClassVar[uint8] = 4
    FILTER_DATE: ClassVar[uint8] = 8
    FILTER_SBAS_FILT: ClassVar[uint8] = 16
    FILTER_TRACK: ClassVar[uint8] = 32
    NMEA_VERSION_2_3: ClassVar[uint8] = 35
    NMEA_VERSION_2_1: ClassVar[uint8] = 33
    FLAGS_COMPAT: ClassVar[uint8] = 1
    FLAGS_CONSIDER: ClassVar[uint8] = 2

    filter: uint8 = 0
    version: uint8 = 0
    num_sv: uint8 = 0
    flags: uint8 = 0


class CfgNMEA7(Message, typename="ublox_msgs/msg/CfgNMEA7"):
    """CfgNMEA7, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 23
    FILTER_POS: ClassVar[uint8] = 1
    FILTER_MSK_POS: ClassVar[uint8] = 2
    FILTER_TIME: ClassVar[uint8] = 4
    FILTER_DATE: ClassVar[uint8] = 8
    FILTER_GPS_ONLY: ClassVar[uint8] = 16
    FILTER_TRACK: ClassVar[uint8] = 32
    NMEA_VERSION_2_3: ClassVar[uint8] = 35
    NMEA_VERSION_2_1: ClassVar[uint8] = 33
    NUM_SV_UNLIMITED: ClassVar[uint8] = 0
    FLAGS_COMPAT: ClassVar[uint8] = 1
    FLAGS_CONSIDER: ClassVar[uint8] = 2
    GNSS_TO_FILTER_GPS: ClassVar[uint32] = 1
    GNSS_TO_FILTER_SBAS: ClassVar[uint32] = 2
    GNSS_TO_FILTER_QZSS: ClassVar[uint32] = 16
    GNSS_TO_FILTER_GLONASS: ClassVar[uint32] = 32
    SV_NUMBERING_STRICT: ClassVar[uint8] = 0
    SV_NUMBERING_EXTENDED: ClassVar[uint8] = 1
    MAIN_TALKER_ID_NOT_OVERRIDDEN: ClassVar[uint8] = 0
    MAIN_TALKER_ID_GP: ClassVar[uint8] = 1
    MAIN_TALKER_ID_GL: ClassVar[uint8] = 2
    MAIN_TALKER_ID_GN: ClassVar[uint8] = 3
    GSV_TALKER_ID_GNSS_SPECIFIC: ClassVar[uint8] = 0
    GSV_TALKER_ID_MAIN: ClassVar[uint8] = 1

    filter: uint8 = 0
    nmea_version: uint8 = 0
    num_sv: uint8 = 0
    flags: uint8 = 0
    gnss_to_filter: uint32 = 0
    sv_numbering: uint8 = 0
    main_talker_id: uint8 = 0
    gsv_talker_id: uint8 = 0
    reserved: uint8 = 0


class CfgPRT(Message, typename="ublox_msgs/msg/CfgPRT"):
    """CfgPRT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 0
    PORT_ID_DDC: ClassVar[uint8] = 0
    PORT_ID_UART1: ClassVar[uint8] = 1
    PORT_ID_UART2: ClassVar[uint8] = 2
    PORT_ID_USB: ClassVar[uint8] = 3
    PORT_ID_SPI: ClassVar[uint8] = 4
    TX_READY_EN: ClassVar[uint16] = 1
    TX_READY_POLARITY_HIGH_ACTIVE: ClassVar[uint16] = 0
    TX_READY_POLARITY_LOW_ACTIVE: ClassVar[uint16] = 2
    TX_READY_PIN_SHIFT: ClassVar[uint16] = 2
    TX_READY_PIN_MASK: ClassVar[uint16] = 124
    TX_READY_THRES_SHIFT: ClassVar[uint16] = 7
    TX_READY_THRES_MASK: ClassVar[uint16] = 65408
    MODE_DDC_SLAVE_ADDR_SHIFT: ClassVar[uint32] = 1
    MODE_DDC_SLAVE_ADDR_MASK: ClassVar[uint32] = 254
    MODE_RESERVED1: ClassVar[uint32] = 16
    MODE_CHAR_LEN_MASK: ClassVar[uint32] = 192
    MODE_CHAR_LEN_5BIT: ClassVar[uint32] = 0
    MODE_CHAR_LEN_6BIT: ClassVar[uint32] = 64
    MODE_CHAR_LEN_7BIT: ClassVar[uint32] = 128
    MODE_CHAR_LEN_8BIT: ClassVar[uint32] = 192
    MODE_PARITY_MASK: ClassVar[uint32] = 3584
    MODE_PARITY_EVEN: ClassVar[uint32] = 0
    MODE_PARITY_ODD: ClassVar[uint32] = 512
    MODE_PARITY_NO: ClassVar[uint32] = 2048
    MODE_STOP_BITS_MASK: ClassVar[uint32] = 12288
    MODE_STOP_BITS_1: ClassVar[uint32] = 0
    MODE_STOP_BITS_15: ClassVar[uint32] = 4096
    MODE_STOP_BITS_2: ClassVar[uint32] = 8192
    MODE_STOP_BITS_05: ClassVar[uint32] = 12288
    MODE_SPI_SPI_MODE_CPOL: ClassVar[uint32] = 4
    MODE_SPI_SPI_MODE_CPHA: ClassVar[uint32] = 2
    MODE_SPI_FLOW_CONTROL: ClassVar[uint32] = 64
    MODE_SPI_FF_COUNT_SHIFT: ClassVar[uint32] = 8
    MODE_SPI_FF_COUNT_MASK: ClassVar[uint32] = 16128
    PROTO_UBX: ClassVar[uint16] = 1
    PROTO_NMEA: ClassVar[uint16] = 2
    PROTO_RTCM: ClassVar[uint16] = 4
    PROTO_RTCM3: ClassVar[uint16] = 32
    FLAGS_EXTENDED_TX_TIMEOUT: ClassVar[uint16] = 2

    port_id: uint8 = 0
    reserved0: uint8 = 0
    tx_ready: uint16 = 0
    mode: uint32 = 0
    baud_rate: uint32 = 0
    in_proto_mask: uint16 = 0
    out_proto_mask: uint16 = 0
    flags: uint16 = 0
    reserved1: uint16 = 0


class CfgRATE(Message, typename="ublox_msgs/msg/CfgRATE"):
    """CfgRATE, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 8
    TIME_REF_UTC: ClassVar[uint16] = 0
    TIME_REF_GPS: ClassVar[uint16] = 1
    TIME_REF_GLONASS: ClassVar[uint16] = 2
    TIME_REF_BEIDOU: ClassVar[uint16] = 3
    TIME_REF_GALILEO: ClassVar[uint16] = 4

    meas_rate: uint16 = 0
    nav_rate: uint16 = 0
    time_ref: uint16 = 0


class CfgRST(Message, typename="ublox_msgs/msg/CfgRST"):
    """CfgRST, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 4
    NAV_BBR_HOT_START: ClassVar[uint16] = 0
    NAV_BBR_WARM_START: ClassVar[uint16] = 1
    NAV_BBR_COLD_START: ClassVar[uint16] = 65535
    NAV_BBR_EPH: ClassVar[uint16] = 1
    NAV_BBR_ALM: ClassVar[uint16] = 2
    NAV_BBR_HEALTH: ClassVar[uint16] = 4
    NAV_BBR_KLOB: ClassVar[uint16] = 8
    NAV_BBR_POS: ClassVar[uint16] = 16
    NAV_BBR_CLKD: ClassVar[uint16] = 32
    NAV_BBR_OSC: ClassVar[uint16] = 64
    NAV_BBR_UTC: ClassVar[uint16] = 128
    NAV_BBR_RTC: ClassVar[uint16] = 256
    NAV_BBR_AOP: ClassVar[uint16] = 32768
    RESET_MODE_HW_IMMEDIATE: ClassVar[uint8] = 0
    RESET_MODE_SW: ClassVar[uint8] = 1
    RESET_MODE_GNSS: ClassVar[uint8] = 2
    RESET_MODE_HW_AFTER_SHUTDOWN: ClassVar[uint8] = 4
    RESET_MODE_GNSS_STOP: ClassVar[uint8] = 8
    RESET_MODE_GNSS_START: ClassVar[uint8] = 9

    nav_bbr_mask: uint16 = 0
    reset_mode: uint8 = 0
    reserved1: uint8 = 0


class CfgSBAS(Message, typename="ublox_msgs/msg/CfgSBAS"):
    """CfgSBAS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 22
    MODE_ENABLED: ClassVar[uint8] = 1
    MODE_TEST: ClassVar[uint8] = 2
    USAGE_RANGE: ClassVar[uint8] = 1
    USAGE_DIFF_CORR: ClassVar[uint8] = 2
    USAGE_INTEGRITY: ClassVar[uint8] = 4

    mode: uint8 = 0
    usage: uint8 = 0
    max_sbas: uint8 = 0
    scanmode2: uint8 = 0
    scanmode1: uint32 = 0


class CfgTMODE3(Message, typename="ublox_msgs/msg/CfgTMODE3"):
    """CfgTMODE3, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 113
    FLAGS_MODE_MASK: ClassVar[uint16] = 255
    FLAGS_MODE_DISABLED: ClassVar[uint16] = 0
    FLAGS_MODE_SURVEY_IN: ClassVar[uint16] = 1
    FLAGS_MODE_FIXED: ClassVar[uint16] = 2
    FLAGS_LLA: ClassVar[uint16] = 256

    version: uint8 = 0
    reserved1: uint8 = 0
    flags: uint16 = 0
    ecef_x_or_lat: int32 = 0
    ecef_y_or_lon: int32 = 0
    ecef_z_or_alt: int32 = 0
    ecef_x_or_lat_hp: int8 = 0
    ecef_y_or_lon_hp: int8 = 0
    ecef_z_or_alt_hp: int8 = 0
    reserved2: uint8 = 0
    fixed_pos_acc: uint32 = 0
    svin_min_dur: uint32 = 0
    svin_acc_limit: uint32 = 0
    reserved3: Annotated[Ints, Array[uint8, 8]] = DEFAULT


class CfgUSB(Message, typename="ublox_msgs/msg/CfgUSB"):
    """CfgUSB, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 27
    FLAGS_RE_ENUM: ClassVar[uint16] = 0
    FLAGS_POWER_MODE: ClassVar[uint16] = 2

    vendor_id: uint16 = 0
    product_id: uint16 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    reserved2: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    power_consumption: uint16 = 0
    flags: uint16 = 0
    vendor_string: Annotated[Ints, Array[int8, 32]] = DEFAULT
    product_string: Annotated[Ints, Array[int8, 32]] = DEFAULT
    serial_number: Annotated[Ints, Array[int8, 32]] = DEFAULT


class CfgVALDEL(Message, typename="ublox_msgs/msg/CfgVALDEL"):
    """CfgVALDEL, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 140
    LAYER_BBR: ClassVar[uint8] = 1
    LAYER_FLASH: ClassVar[uint8] = 2

    version: uint8 = 0
    layers: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    keys: Annotated[Ints, Sequence[uint32]] = DEFAULT


class CfgVALGET(Message, typename="ublox_msgs/msg/CfgVALGET"):
    """CfgVALGET, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 139
    LAYER_RAM: ClassVar[uint8] = 0
    LAYER_BBR: ClassVar[uint8] = 1
    LAYER_FLASH: ClassVar[uint8] = 2
    LAYER_DEFAULT: ClassVar[uint8] = 7

    version: uint8 = 0
    layers: uint8 = 0
    position: uint16 = 0
    keys: Annotated[Ints, Sequence[uint32]] = DEFAULT


class CfgVALSETCfgdata(Message, typename="ublox_msgs/msg/CfgVALSETCfgdata"):
    """CfgVALSETCfgdata, as ublox defines it."""

    GPS_ENABLE: ClassVar[uint32] = 271646751
    GPS_L1CA_ENABLE: ClassVar[uint32] = 271646721
    GPS_L2C_ENABLE: ClassVar[uint32] = 271646723
    SBAS_ENABLE: ClassVar[uint32] = 271646752
    SBAS_L1CA_ENABLE: ClassVar[uint32] = 271646725
    GAL_ENABLE: ClassVar[uint32] = 271646753
    GAL_E1_ENABLE: ClassVar[uint32] = 271646727
    GAL_E5B_ENABLE: ClassVar[uint32] = 271646730
    BDS_ENABLE: ClassVar[uint32] = 271646754
    BDS_B1_ENABLE: ClassVar[uint32] = 271646733
    BDS_B2_ENABLE: ClassVar[uint32] = 271646734
    QZSS_ENABLE: ClassVar[uint32] = 271646756
    QZSS_L1CA_ENABLE: ClassVar[uint32] = 271646738
    QZSS_L1S_ENABLE: ClassVar[uint32] = 271646740
    QZSS_L2C_ENABLE: ClassVar[uint32] = 271646741
    GLO_ENABLE: ClassVar[uint32] = 271646757
    GLO_L1_ENABLE: ClassVar[uint32] = 271646744
    GLO_L2_ENABLE: ClassVar[uint32] = 271646746

    key: uint32 = 0
    data: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class CfgVALSET(Message, typename="ublox_msgs/msg/CfgVALSET"):
    """CfgVALSET, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 6
    MESSAGE_ID: ClassVar[uint8] = 138
    LAYER_RAM: ClassVar[uint8] = 1
    LAYER_BBR: ClassVar[uint8] = 2
    LAYER_FLASH: ClassVar[uint8] = 4

    version: uint8 = 0
    layers: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    cfgdata: Annotated[list[CfgVALSETCfgdata], Sequence[CfgVALSETCfgdata]] = DEFAULT


class EsfINS(Message, typename="ublox_msgs/msg/EsfINS"):
    """EsfINS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 16
    MESSAGE_ID: ClassVar[uint8] = 21
    BITFIELD0_VERSION: ClassVar[uint32] = 255
    BITFIELD0_X_ANG_RATE_VALID: ClassVar[uint32] = 256
    BITFIELD0_Y_ANG_RATE_VALID: ClassVar[uint32] = 512
    BITFIELD0_Z_ANG_RATE_VALID: ClassVar[uint32] = 1024
    BITFIELD0_X_ACCEL_VALID: ClassVar[uint32] = 2048
    BITFIELD0_Y_ACCEL_VALID: ClassVar[uint32] = 4096
    BITFIELD0_Z_ACCEL_VALID: ClassVar[uint32] = 8192

    bitfield0: uint32 = 0
    reserved1: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    i_tow: uint32 = 0
    x_ang_rate: int32 = 0
    y_ang_rate: int32 = 0
    z_ang_rate: int32 = 0
    x_accel: int32 = 0
    y_accel: int32 = 0
    z_accel: int32 = 0


class EsfMEAS(Message, typename="ublox_msgs/msg/EsfMEAS"):
    """EsfMEAS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 16
    MESSAGE_ID: ClassVar[uint8] = 2
    FLAGS_TIME_MARK_SENT_MASK: ClassVar[uint16] = 3
    TIME_MARK_NONE: ClassVar[uint16] = 0
    TIME_MARK_EXT0: ClassVar[uint16] = 1
    TIME_MARK_EXT: ClassVar[uint16] = 2
    FLAGS_TIME_MARK_EDGE: ClassVar[uint16] = 4
    FLAGS_CALIB_T_TAG_VALID: ClassVar[uint16] = 8
    DATA_FIELD_MASK: ClassVar[uint32] = 16777215
    DATA_TYPE_MASK: ClassVar[uint32] = 1056964608
    DATA_TYPE_SHIFT: ClassVar[uint32] = 24
    DATA_TYPE_NONE: ClassVar[uint32] = 0
    DATA_TYPE_Z_AXIS_GYRO: ClassVar[uint32] = 5
    DATA_TYPE_WHEEL_TICKS_FRONT_LEFT: ClassVar[uint32] = 6
    DATA_TYPE_WHEEL_TICKS_FRONT_RIGHT: ClassVar[uint32] = 7
    DATA_TYPE_WHEEL_TICKS_REAR_LEFT: ClassVar[uint32] = 8
    DATA_TYPE_WHEEL_TICKS_REAR_RIGHT: ClassVar[uint32] = 9
    DATA_TYPE_SINGLE_TICK: ClassVar[uint32] = 10
    DATA_TYPE_SPEED: ClassVar[uint32] = 11
    DATA_TYPE_GYRO_TEMPERATURE: ClassVar[uint32] = 12
    DATA_TYPE_GYRO_ANG_RATE_Y: ClassVar[uint32] = 13
    DATA_TYPE_GYRO_ANG_RATE_X: ClassVar[uint32] = 14
    DATA_TYPE_ACCELEROMETER_X: ClassVar[uint32] = 16
    DATA_TYPE_ACCELEROMETER_Y: ClassVar[uint32] = 17
    DATA_TYPE_ACCELEROMETER_Z: ClassVar[uint32] = 18

    time_tag: uint32 = 0
    flags: uint16 = 0
    id: uint16 = 0
    data: Annotated[Ints, Sequence[uint32]] = DEFAULT
    calib_t_tag: Annotated[Ints, Sequence[uint32]] = DEFAULT


class EsfRAWBlock(Message, typename="ublox_msgs/msg/EsfRAWBlock"):
    """EsfRAWBlock, as ublox defines it."""

    DATA_FIELD_MASK: ClassVar[uint32] = 16777215
    DATA_TYPE_MASK: ClassVar[uint32] = 4278190080

    data: uint32 = 0
    s_t_tag: uint32 = 0


class EsfRAW(Message, typename="ublox_msgs/msg/EsfRAW"):
    """EsfRAW, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 16
    MESSAGE_ID: ClassVar[uint8] = 3

    reserved0: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    blocks: Annotated[list[EsfRAWBlock], Sequence[EsfRAWBlock]] = DEFAULT


class EsfSTATUSSens(Message, typename="ublox_msgs/msg/EsfSTATUSSens"):
    """EsfSTATUSSens, as ublox defines it."""

    sens_status1: uint8 = 0
    sens_status2: uint8 = 0
    freq: uint8 = 0
    faults: uint8 = 0


class EsfSTATUS(Message, typename="ublox_msgs/msg/EsfSTATUS"):
    """EsfSTATUS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 16
    MESSAGE_ID: ClassVar[uint8] = 16
    FUSION_MODE_INIT: ClassVar[uint8] = 0
    FUSION_MODE_FUSION: ClassVar[uint8] = 1
    FUSION_MODE_SUSPENDED: ClassVar[uint8] = 2
    FUSION_MODE_DISABLED: ClassVar[uint8] = 3

    i_tow: uint32 = 0
    version: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 7]] = DEFAULT
    fusion_mode: uint8 = 0
    reserved2: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    num_sens: uint8 = 0
    sens: Annotated[list[EsfSTATUSSens], Sequence[EsfSTATUSSens]] = DEFAULT


class HnrPVT(Message, typename="ublox_msgs/msg/HnrPVT"):
    """HnrPVT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 40
    MESSAGE_ID: ClassVar[uint8] = 0
    VALID_DATE: ClassVar[uint8] = 1
    VALID_TIME: ClassVar[uint8] = 2
    VALID_FULLY_RESOLVED: ClassVar[uint8] = 4
    VALID_MAG: ClassVar[uint8] = 8
    FIX_TYPE_NO_FIX: ClassVar[uint8] = 0
    FIX_TYPE_DEAD_RECKONING_ONLY: ClassVar[uint8] = 1
    FIX_TYPE_2D: ClassVar[uint8] = 2
    FIX_TYPE_3D: ClassVar[uint8] = 3
    FIX_TYPE_GPS_DEAD_RECKONING_COMBINED: ClassVar[uint8] = 4
    FIX_TYPE_TIME_ONLY: ClassVar[uint8] = 5
    FLAGS_GNSS_FIX_OK: ClassVar[uint8] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint8] = 2
    FLAGS_WKN_SET: ClassVar[uint8] = 4
    FLAGS_TOW_SET: ClassVar[uint8] = 8
    FLAGS_HEAD_VEH_VALID: ClassVar[uint8] = 32

    i_tow: uint32 = 0
    year: uint16 = 0
    month: uint8 = 0
    day: uint8 = 0
    hour: uint8 = 0
    min: uint8 = 0
    sec: uint8 = 0
    valid: uint8 = 0
    nano: int32 = 0
    gps_fix: uint8 = 0
    flags: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    lon: int32 = 0
    lat: int32 = 0
    height: int32 = 0
    h_msl: int32 = 0
    g_speed: int32 = 0
    speed: int32 = 0
    head_mot: int32 = 0
    head_veh: int32 = 0
    h_acc: uint32 = 0
    v_acc: uint32 = 0
    s_acc: uint32 = 0
    head_acc: uint32 = 0
    reserved1: Annotated[Ints, Array[uint8, 4]] = DEFAULT


class Inf(Message, typename="ublox_msgs/msg/Inf"):
    """Inf, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 4

    str: Annotated[Ints, Sequence[char]] = DEFAULT


class MgaGAL(Message, typename="ublox_msgs/msg/MgaGAL"):
    """MgaGAL, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 19
    MESSAGE_ID: ClassVar[uint8] = 2

    type: uint8 = 0
    version: uint8 = 0
    svid: uint8 = 0
    reserved0: uint8 = 0
    iod_nav: uint16 = 0
    delta_n: int16 = 0
    m0: int32 = 0
    e: uint32 = 0
    sqrt_a: uint32 = 0
    omega0: int32 = 0
    i0: int32 = 0
    omega: int32 = 0
    omega_dot: int32 = 0
    i_dot: int16 = 0
    cuc: int16 = 0
    cus: int16 = 0
    crc: int16 = 0
    crs: int16 = 0
    cic: int16 = 0
    cis: int16 = 0
    toe: uint16 = 0
    af0: int32 = 0
    af1: int32 = 0
    af2: int8 = 0
    sisaindex_e1_e5b: uint8 = 0
    toc: uint16 = 0
    bgd_e1_e5b: int16 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    health_e1b: uint8 = 0
    data_validity_e1b: uint8 = 0
    health_e5b: uint8 = 0
    data_validity_e5b: uint8 = 0
    reserved2: Annotated[Ints, Array[uint8, 4]] = DEFAULT


class MonGNSS(Message, typename="ublox_msgs/msg/MonGNSS"):
    """MonGNSS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 10
    MESSAGE_ID: ClassVar[uint8] = 40
    BIT_MASK_GPS: ClassVar[uint8] = 1
    BIT_MASK_GLONASS: ClassVar[uint8] = 2
    BIT_MASK_BEIDOU: ClassVar[uint8] = 4
    BIT_MASK_GALILEO: ClassVar[uint8] = 8

    version: uint8 = 0
    supported: uint8 = 0
    default_gnss: uint8 = 0
    enabled: uint8 = 0
    simultaneous: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 3]] = DEFAULT


class MonHW(Message, typename="ublox_msgs/msg/MonHW"):
    """MonHW, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 10
    MESSAGE_ID: ClassVar[uint8] = 9
    A_STATUS_INIT: ClassVar[uint8] = 0
    A_STATUS_UNKNOWN: ClassVar[uint8] = 1
    A_STATUS_OK: ClassVar[uint8] = 2
    A_STATUS_SHORT: ClassVar[uint8] = 3
    A_STATUS_OPEN: ClassVar[uint8] = 4
    A_POWER_OFF: ClassVar[uint8] = 0
    A_POWER_ON: ClassVar[uint8] = 1
    A_POWER_UNKNOWN: ClassVar[uint8] = 2
    FLAGS_RTC_CALIB: ClassVar[uint8] = 1
    FLAGS_SAFE_BOOT: ClassVar[uint8] = 2
    FLAGS_JAMMING_STATE_MASK: ClassVar[uint8] = 12
    JAMMING_STATE_UNKNOWN_OR_DISABLED: ClassVar[uint8] = 0
    JAMMING_STATE_OK: ClassVar[uint8] = 4
    JAMMING_STATE_WARNING: ClassVar[uint8] = 8
    JAMMING_STATE_CRITICAL: ClassVar[uint8] = 12
    FLAGS_XTAL_ABSENT: ClassVar[uint8] = 16
    JAM_IND_NONE: ClassVar[uint8] = 0
    JAM_IND_STRONG: ClassVar[uint8] = 255

    pin_sel: uint32 = 0
    pin_bank: uint32 = 0
    pin_dir: uint32 = 0
    pin_val: uint32 = 0
    noise_per_ms: uint16 = 0
    agc_cnt: uint16 = 0
    a_status: uint8 = 0
    a_power: uint8 = 0
    flags: uint8 = 0
    reserved0: uint8 = 0
    used_mask: uint32 = 0
    vp: Annotated[Ints, Array[uint8, 17]] = DEFAULT
    jam_ind: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    pin_irq: uint32 = 0
    pull_h: uint32 = 0
    pull_l: uint32 = 0


class MonHW6(Message, typename="ublox_msgs/msg/MonHW6"):
    """MonHW6, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 10
    MESSAGE_ID: ClassVar[uint8] = 9
    A_STATUS_INIT: ClassVar[uint8] = 0
    A_STATUS_UNKNOWN: ClassVar[uint8] = 1
    A_STATUS_OK: ClassVar[uint8] = 2
    A_STATUS_SHORT: ClassVar[uint8] = 3
    A_STATUS_OPEN: ClassVar[uint8] = 4
    A_POWER_OFF: ClassVar[uint8] = 0
    A_POWER_ON: ClassVar[uint8] = 1
    A_POWER_UNKNOWN: ClassVar[uint8] = 2
    FLAGS_RTC_CALIB: ClassVar[uint8] = 1
    FLAGS_SAFE_BOOT: ClassVar[uint8] = 2
    FLAGS_JAMMING_STATE_MASK: ClassVar[uint8] = 12
    JAMMING_STATE_UNKNOWN_OR_DISABLED: ClassVar[uint8] = 0
    JAMMING_STATE_OK: ClassVar[uint8] = 4
    JAMMING_STATE_WARNING: ClassVar[uint8] = 8
    JAMMING_STATE_CRITICAL: ClassVar[uint8] = 12
    FLAGS_XTAL_ABSENT: ClassVar[uint8] = 16
    JAM_IND_NONE: ClassVar[uint8] = 0
    JAM_IND_STRONG: ClassVar[uint8] = 255

    pin_sel: uint32 = 0
    pin_bank: uint32 = 0
    pin_dir: uint32 = 0
    pin_val: uint32 = 0
    noise_per_ms: uint16 = 0
    agc_cnt: uint16 = 0
    a_status: uint8 = 0
    a_power: uint8 = 0
    flags: uint8 = 0
    reserved0: uint8 = 0
    used_mask: uint32 = 0
    vp: Annotated[Ints, Array[uint8, 25]] = DEFAULT
    jam_ind: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    pin_irq: uint32 = 0
    pull_h: uint32 = 0
    pull_l: uint32 = 0


class MonVERExtension(Message, typename="ublox_msgs/msg/MonVERExtension"):
    """MonVERExtension, as ublox defines it."""

    field: Annotated[Ints, Array[char, 30]] = DEFAULT


class MonVER(Message, typename="ublox_msgs/msg/MonVER"):
    """MonVER, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 10
    MESSAGE_ID: ClassVar[uint8] = 4

    sw_version: Annotated[Ints, Array[char, 30]] = DEFAULT
    hw_version: Annotated[Ints, Array[char, 10]] = DEFAULT
    extension: Annotated[list[MonVERExtension], Sequence[MonVERExtension]] = DEFAULT


class NavATT(Message, typename="ublox_msgs/msg/NavATT"):
    """NavATT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 5

    i_tow: uint32 = 0
    version: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    roll: int32 = 0
    pitch: int32 = 0
    heading: int32 = 0
    acc_roll: uint32 = 0
    acc_pitch: uint32 = 0
    acc_heading: uint32 = 0


class NavCLOCK(Message, typename="ublox_msgs/msg/NavCLOCK"):
    """NavCLOCK, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 34

    i_tow: uint32 = 0
    clk_b: int32 = 0
    clk_d: int32 = 0
    t_acc: uint32 = 0
    f_acc: uint32 = 0


class NavCOV(Message, typename="ublox_msgs/msg/NavCOV"):
    """NavCOV, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 54

    i_tow: uint32 = 0
    version: uint8 = 0
    pos_cov_valid: uint8 = 0
    vel_cov_valid: uint8 = 0
    reserved_0: Annotated[Ints, Array[uint8, 9]] = DEFAULT
    pos_cov_nn: float32 = 0.0
    pos_cov_ne: float32 = 0.0
    pos_cov_nd: float32 = 0.0
    pos_cov_ee: float32 = 0.0
    pos_cov_ed: float32 = 0.0
    pos_cov_dd: float32 = 0.0
    vel_cov_nn: float32 = 0.0
    vel_cov_ne: float32 = 0.0
    vel_cov_nd: float32 = 0.0
    vel_cov_ee: float32 = 0.0
    vel_cov_ed: float32 = 0.0
    vel_cov_dd: float32 = 0.0


class NavDGPSSV(Message, typename="ublox_msgs/msg/NavDGPSSV"):
    """NavDGPSSV, as ublox defines it."""

    FLAGS_CHANNEL_MASK: ClassVar[uint8] = 15
    FLAGS_DGPS: ClassVar[uint8] = 16

    svid: uint8 = 0
    flags: uint8 = 0
    age_c: uint16 = 0
    prc: float32 = 0.0
    prrc: float32 = 0.0


class NavDGPS(Message, typename="ublox_msgs/msg/NavDGPS"):
    """NavDGPS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 49
    DGPS_CORRECTION_NONE: ClassVar[uint8] = 0
    DGPS_CORRECTION_PR_PRR: ClassVar[uint8] = 1

    i_tow: uint32 = 0
    age: int32 = 0
    base_id: int16 = 0
    base_health: int16 = 0
    num_ch: int8 = 0
    status: uint8 = 0
    reserved1: uint16 = 0
    sv: Annotated[list[NavDGPSSV], Sequence[NavDGPSSV]] = DEFAULT


class NavDOP(Message, typename="ublox_msgs/msg/NavDOP"):
    """NavDOP, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 4

    i_tow: uint32 = 0
    g_dop: uint16 = 0
    p_dop: uint16 = 0
    t_dop: uint16 = 0
    v_dop: uint16 = 0
    h_dop: uint16 = 0
    n_dop: uint16 = 0
    e_dop: uint16 = 0


class NavPOSECEF(Message, typename="ublox_msgs/msg/NavPOSECEF"):
    """NavPOSECEF, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 1

    i_tow: uint32 = 0
    ecef_x: int32 = 0
    ecef_y: int32 = 0
    ecef_z: int32 = 0
    p_acc: uint32 = 0


class NavPOSLLH(Message, typename="ublox_msgs/msg/NavPOSLLH"):
    """NavPOSLLH, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 2

    i_tow: uint32 = 0
    lon: int32 = 0
    lat: int32 = 0
    height: int32 = 0
    h_msl: int32 = 0
    h_acc: uint32 = 0
    v_acc: uint32 = 0


class NavPVT(Message, typename="ublox_msgs/msg/NavPVT"):
    """NavPVT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 7
    VALID_DATE: ClassVar[uint8] = 1
    VALID_TIME: ClassVar[uint8] = 2
    VALID_FULLY_RESOLVED: ClassVar[uint8] = 4
    VALID_MAG: ClassVar[uint8] = 8
    FIX_TYPE_NO_FIX: ClassVar[uint8] = 0
    FIX_TYPE_DEAD_RECKONING_ONLY: ClassVar[uint8] = 1
    FIX_TYPE_2D: ClassVar[uint8] = 2
    FIX_TYPE_3D: ClassVar[uint8] = 3
    FIX_TYPE_GNSS_DEAD_RECKONING_COMBINED: ClassVar[uint8] = 4
    FIX_TYPE_TIME_ONLY: ClassVar[uint8] = 5
    FLAGS_GNSS_FIX_OK: ClassVar[uint8] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint8] = 2
    FLAGS_PSM_MASK: ClassVar[uint8] = 28
    PSM_OFF: ClassVar[uint8] = 0
    PSM_ENABLED: ClassVar[uint8] = 4
    PSM_ACQUIRED: ClassVar[uint8] = 8
    PSM_TRACKING: ClassVar[uint8] = 12
    PSM_POWER_OPTIMIZED_TRACKING: ClassVar[uint8] = 16
    PSM_INACTIVE: ClassVar[uint8] = 20
    FLAGS_HEAD_VEH_VALID: ClassVar[uint8] = 32
    FLAGS_CARRIER_PHASE_MASK: ClassVar[uint8] = 192
    CARRIER_PHASE_NO_SOLUTION: ClassVar[uint8] = 0
    CARRIER_PHASE_FLOAT: ClassVar[uint8] = 64
    CARRIER_PHASE_FIXED: ClassVar[uint8] = 128
    FLAGS2_CONFIRMED_AVAILABLE: ClassVar[uint8] = 32
    FLAGS2_CONFIRMED_DATE: ClassVar[uint8] = 64
    FLAGS2_CONFIRMED_TIME: ClassVar[uint8] = 128

    i_tow: uint32 = 0
    year: uint16 = 0
    month: uint8 = 0
    day: uint8 = 0
    hour: uint8 = 0
    min: uint8 = 0
    sec: uint8 = 0
    valid: uint8 = 0
    t_acc: uint32 = 0
    nano: int32 = 0
    fix_type: uint8 = 0
    flags: uint8 = 0
    flags2: uint8 = 0
    num_sv: uint8 = 0
    lon: int32 = 0
    lat: int32 = 0
    height: int32 = 0
    h_msl: int32 = 0
    h_acc: uint32 = 0
    v_acc: uint32 = 0
    vel_n: int32 = 0
    vel_e: int32 = 0
    vel_d: int32 = 0
    g_speed: int32 = 0
    heading: int32 = 0
    s_acc: uint32 = 0
    head_acc: uint32 = 0
    p_dop: uint16 = 0
    reserved1: Annotated[Ints, Array[uint8, 6]] = DEFAULT
    head_veh: int32 = 0
    mag_dec: int16 = 0
    mag_acc: uint16 = 0


class NavPVT7(Message, typename="ublox_msgs/msg/NavPVT7"):
    """NavPVT7, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 7
    VALID_DATE: ClassVar[uint8] = 1
    VALID_TIME: ClassVar[uint8] = 2
    VALID_FULLY_RESOLVED: ClassVar[uint8] = 4
    VALID_MAG: ClassVar[uint8] = 8
    FIX_TYPE_NO_FIX: ClassVar[uint8] = 0
    FIX_TYPE_DEAD_RECKONING_ONLY: ClassVar[uint8] = 1
    FIX_TYPE_2D: ClassVar[uint8] = 2
    FIX_TYPE_3D: ClassVar[uint8] = 3
    FIX_TYPE_GNSS_DEAD_RECKONING_COMBINED: ClassVar[uint8] = 4
    FIX_TYPE_TIME_ONLY: ClassVar[uint8] = 5
    FLAGS_GNSS_FIX_OK: ClassVar[uint8] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint8] = 2
    FLAGS_PSM_MASK: ClassVar[uint8] = 28
    PSM_OFF: ClassVar[uint8] = 0
    PSM_ENABLED: ClassVar[uint8] = 4
    PSM_ACQUIRED: ClassVar[uint8] = 8
    PSM_TRACKING: ClassVar[uint8] = 12
    PSM_POWER_OPTIMIZED_TRACKING: ClassVar[uint8] = 16
    PSM_INACTIVE: ClassVar[uint8] = 20
    FLAGS_HEAD_VEH_VALID: ClassVar[uint8] = 32
    FLAGS_CARRIER_PHASE_MASK: ClassVar[uint8] = 192
    CARRIER_PHASE_NO_SOLUTION: ClassVar[uint8] = 0
    CARRIER_PHASE_FLOAT: ClassVar[uint8] = 64
    CARRIER_PHASE_FIXED: ClassVar[uint8] = 128
    FLAGS2_CONFIRMED_AVAILABLE: ClassVar[uint8] = 32
    FLAGS2_CONFIRMED_DATE: ClassVar[uint8] = 64
    FLAGS2_CONFIRMED_TIME: ClassVar[uint8] = 128

    i_tow: uint32 = 0
    year: uint16 = 0
    month: uint8 = 0
    day: uint8 = 0
    hour: uint8 = 0
    min: uint8 = 0
    sec: uint8 = 0
    valid: uint8 = 0
    t_acc: uint32 = 0
    nano: int32 = 0
    fix_type: uint8 = 0
    flags: uint8 = 0
    flags2: uint8 = 0
    num_sv: uint8 = 0
    lon: int32 = 0
    lat: int32 = 0
    height: int32 = 0
    h_msl: int32 = 0
    h_acc: uint32 = 0
    v_acc: uint32 = 0
    vel_n: int32 = 0
    vel_e: int32 = 0
    vel_d: int32 = 0
    g_speed: int32 = 0
    heading: int32 = 0
    s_acc: uint32 = 0
    head_acc: uint32 = 0
    p_dop: uint16 = 0
    reserved1: Annotated[Ints, Array[uint8, 6]] = DEFAULT


class NavRELPOSNED(Message, typename="ublox_msgs/msg/NavRELPOSNED"):
    """NavRELPOSNED, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 60
    FLAGS_GNSS_FIX_OK: ClassVar[uint32] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint32] = 2
    FLAGS_REL_POS_VALID: ClassVar[uint32] = 4
    FLAGS_CARR_SOLN_MASK: ClassVar[uint32] = 24
    FLAGS_CARR_SOLN_NONE: ClassVar[uint32] = 0
    FLAGS_CARR_SOLN_FLOAT: ClassVar[uint32] = 8
    FLAGS_CARR_SOLN_FIXED: ClassVar[uint32] = 16
    FLAGS_IS_MOVING: ClassVar[uint32] = 32
    FLAGS_REF_POS_MISS: ClassVar[uint32] = 64
    FLAGS_REF_OBS_MISS: ClassVar[uint32] = 128

    version: uint8 = 0
    reserved0: uint8 = 0
    ref_station_id: uint16 = 0
    i_tow: uint32 = 0
    rel_pos_n: int32 = 0
    rel_pos_e: int32 = 0
    rel_pos_d: int32 = 0
    rel_pos_hpn: int8 = 0
    rel_pos_hpe: int8 = 0
    rel_pos_hpd: int8 = 0
    reserved1: uint8 = 0
    acc_n: uint32 = 0
    acc_e: uint32 = 0
    acc_d: uint32 = 0
    flags: uint32 = 0


class NavRELPOSNED9(Message, typename="ublox_msgs/msg/NavRELPOSNED9"):
    """NavRELPOSNED9, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 60
    FLAGS_GNSS_FIX_OK: ClassVar[uint32] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint32] = 2
    FLAGS_REL_POS_VALID: ClassVar[uint32] = 4
    FLAGS_CARR_SOLN_MASK: ClassVar[uint32] = 24
    FLAGS_CARR_SOLN_NONE: ClassVar[uint32] = 0
    FLAGS_CARR_SOLN_FLOAT: ClassVar[uint32] = 8
    FLAGS_CARR_SOLN_FIXED: ClassVar[uint32] = 16
    FLAGS_IS_MOVING: ClassVar[uint32] = 32
    FLAGS_REF_POS_MISS: ClassVar[uint32] = 64
    FLAGS_REF_OBS_MISS: ClassVar[uint32] = 128
    FLAGS_REL_POS_HEAD_VALID: ClassVar[uint32] = 256
    FLAGS_REL_POS_NORM: ClassVar[uint32] = 512

    version: uint8 = 0
    reserved1: uint8 = 0
    ref_station_id: uint16 = 0
    i_tow: uint32 = 0
    rel_pos_n: int32 = 0
    rel_pos_e: int32 = 0
    rel_pos_d: int32 = 0
    rel_pos_length: int32 = 0
    rel_pos_heading: int32 = 0
    reserved2: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    rel_pos_hpn: int8 = 0
    rel_pos_hpe: int8 = 0
    rel_pos_hpd: int8 = 0
    rel_pos_hp_length: int8 = 0
    acc_n: uint32 = 0
    acc_e: uint32 = 0
    acc_d: uint32 = 0
    acc_length: uint32 = 0
    acc_heading: uint32 = 0
    reserved3: Annotated[Ints, Array[uint8, 4]] = DEFAULT
    flags: uint32 = 0


class NavSATSV(Message, typename="ublox_msgs/msg/NavSATSV"):
    """NavSATSV, as ublox defines it."""

    FLAGS_QUALITY_IND_MASK: ClassVar[uint32] = 7
    QUALITY_IND_NO_SIGNAL: ClassVar[uint8] = 0
    QUALITY_IND_SEARCHING_SIGNAL: ClassVar[uint8] = 1
    QUALITY_IND_SIGNAL_ACQUIRED: ClassVar[uint8] = 2
    QUALITY_IND_SIGNAL_DETECTED_BUT_UNUSABLE: ClassVar[uint8] = 3
    QUALITY_IND_CODE_LOCKED_AND_TIME_SYNC: ClassVar[uint8] = 4
    QUALITY_IND_CODE_AND_CARR_LOCK_AND_TIME_SYNC1: ClassVar[uint8] = 5
    QUALITY_IND_CODE_AND_CARR_LOCK_AND_TIME_SYNC2: ClassVar[uint8] = 6
    QUALITY_IND_CODE_AND_CARR_LOCK_AND_TIME_SYNC3: ClassVar[uint8] = 7
    FLAGS_SV_USED: ClassVar[uint32] = 8
    FLAGS_HEALTH_MASK: ClassVar[uint32] = 48
    HEALTH_UNKNOWN: ClassVar[uint32] = 0
    HEALTH_HEALTHY: ClassVar[uint32] = 1
    HEALTH_UNHEALTHY: ClassVar[uint32] = 2
    FLAGS_DIFF_CORR: ClassVar[uint32] = 64
    FLAGS_SMOOTHED: ClassVar[uint32] = 128
    FLAGS_ORBIT_SOURCE_MASK: ClassVar[uint32] = 1792
    ORBIT_SOURCE_UNAVAILABLE: ClassVar[uint32] = 0
    ORBIT_SOURCE_EPH: ClassVar[uint32] = 256
    ORBIT_SOURCE_ALM: ClassVar[uint32] = 512
    ORBIT_SOURCE_ASSIST_OFFLINE: ClassVar[uint32] = 768
    ORBIT_SOURCE_ASSIST_AUTONOMOUS: ClassVar[uint32] = 1024
    ORBIT_SOURCE_OTHER1: ClassVar[uint32] = 1280
    ORBIT_SOURCE_OTHER2: ClassVar[uint32] = 1536
    ORBIT_SOURCE_OTHER3: ClassVar[uint32] = 1792
    FLAGS_EPH_AVAIL: ClassVar[uint32] = 2048
    FLAGS_ALM_AVAIL: ClassVar[uint32] = 4096
    FLAGS_ANO_AVAIL: ClassVar[uint32] = 8192
    FLAGS_AOP_AVAIL: ClassVar[uint32] = 16384
    FLAGS_SBAS_CORR_USED: ClassVar[uint32] = 65536
    FLAGS_RTCM_CORR_USED: ClassVar[uint32] = 131072
    FLAGS_PR_CORR_USED: ClassVar[uint32] = 1048576
    FLAGS_CR_CORR_USED: ClassVar[uint32] = 2097152
    FLAGS_DO_CORR_USED: ClassVar[uint32] = 4194304

    gnss_id: uint8 = 0
    sv_id: uint8 = 0
    cno: uint8 = 0
    elev: int8 = 0
    azim: int16 = 0
    pr_res: int16 = 0
    flags: uint32 = 0


class NavSAT(Message, typename="ublox_msgs/msg/NavSAT"):
    """NavSAT, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 53

    i_tow: uint32 = 0
    version: uint8 = 0
    num_svs: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    sv: Annotated[list[NavSATSV], Sequence[NavSATSV]] = DEFAULT


class NavSBASSV(Message, typename="ublox_msgs/msg/NavSBASSV"):
    """NavSBASSV, as ublox defines it."""

    svid: uint8 = 0
    flags: uint8 = 0
    udre: uint8 = 0
    sv_sys: uint8 = 0
    sv_service: uint8 = 0
    reserved1: uint8 = 0
    prc: int16 = 0
    reserved2: uint16 = 0
    ic: int16 = 0


class NavSBAS(Message, typename="ublox_msgs/msg/NavSBAS"):
    """NavSBAS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 50
    MODE_DISABLED: ClassVar[uint8] = 0
    MODE_ENABLED_INTEGRITY: ClassVar[uint8] = 1
    MODE_ENABLED_TESTMODE: ClassVar[uint8] = 3
    SYS_UNKNOWN: ClassVar[int8] = -1
    SYS_WAAS: ClassVar[int8] = 0
    SYS_EGNOS: ClassVar[int8] = 1
    SYS_MSAS: ClassVar[int8] = 2
    SYS_GAGAN: ClassVar[int8] = 3
    SYS_GPS: ClassVar[int8] = 16
    SERVICE_RANGING: ClassVar[uint8] = 1
    SERVICE_CORRECTIONS: ClassVar[uint8] = 2
    SERVICE_INTEGRITY: ClassVar[uint8] = 4
    SERVICE_TESTMODE: ClassVar[uint8] = 8

    i_tow: uint32 = 0
    geo: uint8 = 0
    mode: uint8 = 0
    sys: int8 = 0
    service: uint8 = 0
    cnt: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    sv: Annotated[list[NavSBASSV], Sequence[NavSBASSV]] = DEFAULT


class NavSOL(Message, typename="ublox_msgs/msg/NavSOL"):
    """NavSOL, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 6
    GPS_NO_FIX: ClassVar[uint8] = 0
    GPS_DEAD_RECKONING_ONLY: ClassVar[uint8] = 1
    GPS_2D_FIX: ClassVar[uint8] = 2
    GPS_3D_FIX: ClassVar[uint8] = 3
    GPS_GPS_DEAD_RECKONING_COMBINED: ClassVar[uint8] = 4
    GPS_TIME_ONLY_FIX: ClassVar[uint8] = 5
    FLAGS_GPS_FIX_OK: ClassVar[uint8] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint8] = 2
    FLAGS_WKNSET: ClassVar[uint8] = 4
    FLAGS_TOWSET: ClassVar[uint8] = 8

    i_tow: uint32 = 0
    f_tow: int32 = 0
    week: int16 = 0
    gps_fix: uint8 = 0
    flags: uint8 = 0
    ecef_x: int32 = 0
    ecef_y: int32 = 0
    ecef_z: int32 = 0
    p_acc: uint32 = 0
    ecef_vx: int32 = 0
    ecef_vy: int32 = 0
    ecef_vz: int32 = 0
    s_acc: uint32 = 0
    p_dop: uint16 = 0
    reserved1: uint8 = 0
    num_sv: uint8 = 0
    reserved2: uint32 = 0


class NavSTATUS(Message, typename="ublox_msgs/msg/NavSTATUS"):
    """NavSTATUS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 3
    GPS_NO_FIX: ClassVar[uint8] = 0
    GPS_DEAD_RECKONING_ONLY: ClassVar[uint8] = 1
    GPS_2D_FIX: ClassVar[uint8] = 2
    GPS_3D_FIX: ClassVar[uint8] = 3
    GPS_GPS_DEAD_RECKONING_COMBINED: ClassVar[uint8] = 4
    GPS_TIME_ONLY_FIX: ClassVar[uint8] = 5
    FLAGS_GPS_FIX_OK: ClassVar[uint8] = 1
    FLAGS_DIFF_SOLN: ClassVar[uint8] = 2
    FLAGS_WKNSET: ClassVar[uint8] = 4
    FLAGS_TOWSET: ClassVar[uint8] = 8
    FIX_STAT_DIFF_CORR_MASK: ClassVar[uint8] = 1
    FIX_STAT_MAP_MATCHING_MASK: ClassVar[uint8] = 192
    MAP_MATCHING_NONE: ClassVar[uint8] = 0
    MAP_MATCHING_VALID: ClassVar[uint8] = 64
    MAP_MATCHING_USED: ClassVar[uint8] = 128
    MAP_MATCHING_DR: ClassVar[uint8] = 192
    FLAGS2_PSM_STATE_MASK: ClassVar[uint8] = 3
    PSM_STATE_ACQUISITION: ClassVar[uint8] = 0
    PSM_STATE_TRACKING: ClassVar[uint8] = 1
    PSM_STATE_POWER_OPTIMIZED_TRACKING: ClassVar[uint8] = 2
    PSM_STATE_INACTIVE: ClassVar[uint8] = 3
    FLAGS2_SPOOF_DET_STATE_MASK: ClassVar[uint8] = 24
    SPOOF_DET_STATE_UNKNOWN: ClassVar[uint8] = 0
    SPOOF_DET_STATE_NONE: ClassVar[uint8] = 8
    SPOOF_DET_STATE_SPOOFING: ClassVar[uint8] = 16
    SPOOF_DET_STATE_MULTIPLE: ClassVar[uint8] = 24

    i_tow: uint32 = 0
    gps_fix: uint8 = 0
    flags: uint8 = 0
    fix_stat: uint8 = 0
    flags2: uint8 = 0
    ttff: uint32 = 0
    msss: uint32 = 0


class NavSVIN(Message, typename="ublox_msgs/msg/NavSVIN"):
    """NavSVIN, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 59

    version: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    i_tow: uint32 = 0
    dur: uint32 = 0
    mean_x: int32 = 0
    mean_y: int32 = 0
    mean_z: int32 = 0
    mean_xhp: int8 = 0
    mean_yhp: int8 = 0
    mean_zhp: int8 = 0
    reserved1: uint8 = 0
    mean_acc: uint32 = 0
    obs: uint32 = 0
    valid: uint8 = 0
    active: uint8 = 0
    reserved3: Annotated[Ints, Array[uint8, 2]] = DEFAULT


class NavSVINFOSV(Message, typename="ublox_msgs/msg/NavSVINFOSV"):
    """NavSVINFOSV, as ublox defines it."""

    FLAGS_SV_USED: ClassVar[uint8] = 1
    FLAGS_DIFF_CORR: ClassVar[uint8] = 2
    FLAGS_ORBIT_AVAIL: ClassVar[uint8] = 4
    FLAGS_ORBIT_EPH: ClassVar[uint8] = 8
    FLAGS_UNHEALTHY: ClassVar[uint8] = 16
    FLAGS_ORBIT_ALM: ClassVar[uint8] = 32
    FLAGS_ORBIT_AOP: ClassVar[uint8] = 64
    FLAGS_SMOOTHED: ClassVar[uint8] = 128
    QUALITY_IDLE: ClassVar[uint8] = 0
    QUALITY_SEARCHING: ClassVar[uint8] = 1
    QUALITY_ACQUIRED: ClassVar[uint8] = 2
    QUALITY_DETECTED: ClassVar[uint8] = 3
    QUALITY_CODE_LOCK: ClassVar[uint8] = 4
    QUALITY_CODE_AND_CARRIER_LOCKED1: ClassVar[uint8] = 5
    QUALITY_CODE_AND_CARRIER_LOCKED2: ClassVar[uint8] = 6
    QUALITY_CODE_AND_CARRIER_LOCKED3: ClassVar[uint8] = 7

    chn: uint8 = 0
    svid: uint8 = 0
    flags: uint8 = 0
    quality: uint8 = 0
    cno: uint8 = 0
    elev: int8 = 0
    azim: int16 = 0
    pr_res: int32 = 0


class NavSVINFO(Message, typename="ublox_msgs/msg/NavSVINFO"):
    """NavSVINFO, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 48
    CHIPGEN_ANTARIS: ClassVar[uint8] = 0
    CHIPGEN_UBLOX5: ClassVar[uint8] = 1
    CHIPGEN_UBLOX6: ClassVar[uint8] = 2
    CHIPGEN_UBLOX7: ClassVar[uint8] = 3
    CHIPGEN_UBLOX8: ClassVar[uint8] = 4

    i_tow: uint32 = 0
    num_ch: uint8 = 0
    global_flags: uint8 = 0
    reserved2: uint16 = 0
    sv: Annotated[list[NavSVINFOSV], Sequence[NavSVINFOSV]] = DEFAULT


class NavTIMEGPS(Message, typename="ublox_msgs/msg/NavTIMEGPS"):
    """NavTIMEGPS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 32
    VALID_TOW: ClassVar[uint8] = 1
    VALID_WEEK: ClassVar[uint8] = 2
    VALID_LEAP_S: ClassVar[uint8] = 4

    i_tow: uint32 = 0
    f_tow: int32 = 0
    week: int16 = 0
    leap_s: int8 = 0
    valid: uint8 = 0
    t_acc: uint32 = 0


class NavTIMEUTC(Message, typename="ublox_msgs/msg/NavTIMEUTC"):
    """NavTIMEUTC, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 33
    VALID_TOW: ClassVar[uint8] = 1
    VALID_WKN: ClassVar[uint8] = 2
    VALID_UTC: ClassVar[uint8] = 4
    VALID_UTC_STANDARD_MASK: ClassVar[uint8] = 240
    UTC_STANDARD_NOT_AVAILABLE: ClassVar[uint8] = 0
    UTC_STANDARD_CRL: ClassVar[uint8] = 16
    UTC_STANDARD_NIST: ClassVar[uint8] = 32
    UTC_STANDARD_USNO: ClassVar[uint8] = 48
    UTC_STANDARD_BIPM: ClassVar[uint8] = 64
    UTC_STANDARD_EL: ClassVar[uint8] = 80
    UTC_STANDARD_SU: ClassVar[uint8] = 96
    UTC_STANDARD_NTSC: ClassVar[uint8] = 112
    UTC_STANDARD_UNKNOWN: ClassVar[uint8] = 240

    i_tow: uint32 = 0
    t_acc: uint32 = 0
    nano: int32 = 0
    year: uint16 = 0
    month: uint8 = 0
    day: uint8 = 0
    hour: uint8 = 0
    min: uint8 = 0
    sec: uint8 = 0
    valid: uint8 = 0


class NavVELECEF(Message, typename="ublox_msgs/msg/NavVELECEF"):
    """NavVELECEF, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 17

    i_tow: uint32 = 0
    ecef_vx: int32 = 0
    ecef_vy: int32 = 0
    ecef_vz: int32 = 0
    s_acc: uint32 = 0


class NavVELNED(Message, typename="ublox_msgs/msg/NavVELNED"):
    """NavVELNED, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 1
    MESSAGE_ID: ClassVar[uint8] = 18

    i_tow: uint32 = 0
    vel_n: int32 = 0
    vel_e: int32 = 0
    vel_d: int32 = 0
    speed: uint32 = 0
    g_speed: uint32 = 0
    heading: int32 = 0
    s_acc: uint32 = 0
    c_acc: uint32 = 0


class RxmALM(Message, typename="ublox_msgs/msg/RxmALM"):
    """RxmALM, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 48

    svid: uint32 = 0
    week: uint32 = 0
    dwrd: Annotated[Ints, Sequence[uint32]] = DEFAULT


class RxmEPH(Message, typename="ublox_msgs/msg/RxmEPH"):
    """RxmEPH, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 49

    svid: uint32 = 0
    how: uint32 = 0
    sf1d: Annotated[Ints, Sequence[uint32]] = DEFAULT
    sf2d: Annotated[Ints, Sequence[uint32]] = DEFAULT
    sf3d: Annotated[Ints, Sequence[uint32]] = DEFAULT


class RxmRAWSV(Message, typename="ublox_msgs/msg/RxmRAWSV"):
    """RxmRAWSV, as ublox defines it."""

    cp_mes: float64 = 0.0
    pr_mes: float64 = 0.0
    do_mes: float32 = 0.0
    sv: uint8 = 0
    mes_qi: int8 = 0
    cno: int8 = 0
    lli: uint8 = 0


class RxmRAW(Message, typename="ublox_msgs/msg/RxmRAW"):
    """RxmRAW, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 16

    rcv_tow: int32 = 0
    week: int16 = 0
    num_sv: uint8 = 0
    reserved1: uint8 = 0
    sv: Annotated[list[RxmRAWSV], Sequence[RxmRAWSV]] = DEFAULT


class RxmRAWXMeas(Message, typename="ublox_msgs/msg/RxmRAWXMeas"):
    """RxmRAWXMeas, as ublox defines it."""

    TRK_STAT_PR_VALID: ClassVar[uint8] = 1
    TRK_STAT_CP_VALID: ClassVar[uint8] = 2
    TRK_STAT_HALF_CYC: ClassVar[uint8] = 4
    TRK_STAT_SUB_HALF_CYC: ClassVar[uint8] = 8

    pr_mes: float64 = 0.0
    cp_mes: float64 = 0.0
    do_mes: float32 = 0.0
    gnss_id: uint8 = 0
    sv_id: uint8 = 0
    reserved0: uint8 = 0
    freq_id: uint8 = 0
    locktime: uint16 = 0
    cno: int8 = 0
    pr_stdev: uint8 = 0
    cp_stdev: uint8 = 0
    do_stdev: uint8 = 0
    trk_stat: uint8 = 0
    reserved1: uint8 = 0


class RxmRAWX(Message, typename="ublox_msgs/msg/RxmRAWX"):
    """RxmRAWX, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 21
    REC_STAT_LEAP_SEC: ClassVar[uint8] = 1
    REC_STAT_CLK_RESET: ClassVar[uint8] = 2

    rcv_tow: float64 = 0.0
    week: uint16 = 0
    leap_s: int8 = 0
    num_meas: uint8 = 0
    rec_stat: uint8 = 0
    version: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    meas: Annotated[list[RxmRAWXMeas], Sequence[RxmRAWXMeas]] = DEFAULT


class RxmRTCM(Message, typename="ublox_msgs/msg/RxmRTCM"):
    """RxmRTCM, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 50
    FLAGS_CRC_FAILED: ClassVar[uint8] = 1

    version: uint8 = 0
    flags: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 2]] = DEFAULT
    ref_station: uint16 = 0
    msg_type: uint16 = 0


class RxmSFRB(Message, typename="ublox_msgs/msg/RxmSFRB"):
    """RxmSFRB, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 17

    chn: uint8 = 0
    svid: uint8 = 0
    dwrd: Annotated[Ints, Array[uint32, 10]] = DEFAULT


class RxmSFRBX(Message, typename="ublox_msgs/msg/RxmSFRBX"):
    """RxmSFRBX, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 19

    gnss_id: uint8 = 0
    sv_id: uint8 = 0
    reserved0: uint8 = 0
    freq_id: uint8 = 0
    num_words: uint8 = 0
    chn: uint8 = 0
    version: uint8 = 0
    reserved1: uint8 = 0
    dwrd: Annotated[Ints, Sequence[uint32]] = DEFAULT


class RxmSVSISV(Message, typename="ublox_msgs/msg/RxmSVSISV"):
    """RxmSVSISV, as ublox defines it."""

    FLAG_URA_MASK: ClassVar[uint8] = 15
    FLAG_HEALTHY: ClassVar[uint8] = 16
    FLAG_EPH_VAL: ClassVar[uint8] = 32
    FLAG_ALM_VAL: ClassVar[uint8] = 64
    FLAG_NOT_AVAIL: ClassVar[uint8] = 128
    AGE_ALM_MASK: ClassVar[uint8] = 15
    AGE_EPH_MASK: ClassVar[uint8] = 240

    svid: uint8 = 0
    sv_flag: uint8 = 0
    azim: int16 = 0
    elev: int8 = 0
    age: uint8 = 0


class RxmSVSI(Message, typename="ublox_msgs/msg/RxmSVSI"):
    """RxmSVSI, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 2
    MESSAGE_ID: ClassVar[uint8] = 32

    i_tow: int32 = 0
    week: int16 = 0
    num_vis: uint8 = 0
    num_sv: uint8 = 0
    sv: Annotated[list[RxmSVSISV], Sequence[RxmSVSISV]] = DEFAULT


class TimTM2(Message, typename="ublox_msgs/msg/TimTM2"):
    """TimTM2, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 13
    MESSAGE_ID: ClassVar[uint8] = 3
    FLAGS_MODE_RUNNING: ClassVar[uint8] = 1
    FLAGS_RUN: ClassVar[uint8] = 2
    FLAGS_NEWFALLINGEDGE: ClassVar[uint8] = 4
    FLAGS_TIMEBASE_GNSS: ClassVar[uint8] = 8
    FLAGS_TIMEBASE_UTC: ClassVar[uint8] = 16
    FLAGS_UTC_AVAIL: ClassVar[uint8] = 32
    FLAGS_TIME_VALID: ClassVar[uint8] = 64
    FLAGS_NEWRISINGEDGE: ClassVar[uint8] = 128

    ch: uint8 = 0
    flags: uint8 = 0
    rising_edge_count: uint16 = 0
    wn_r: uint16 = 0
    wn_f: uint16 = 0
    tow_ms_r: uint32 = 0
    tow_sub_ms_r: uint32 = 0
    tow_ms_f: uint32 = 0
    tow_sub_ms_f: uint32 = 0
    acc_est: uint32 = 0


class UpdSOS(Message, typename="ublox_msgs/msg/UpdSOS"):
    """UpdSOS, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 9
    MESSAGE_ID: ClassVar[uint8] = 20
    CMD_FLASH_BACKUP_CREATE: ClassVar[uint8] = 0
    CMD_FLASH_BACKUP_CLEAR: ClassVar[uint8] = 1

    cmd: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 3]] = DEFAULT


class UpdSOSAck(Message, typename="ublox_msgs/msg/UpdSOSAck"):
    """UpdSOSAck, as ublox defines it."""

    CLASS_ID: ClassVar[uint8] = 9
    MESSAGE_ID: ClassVar[uint8] = 20
    CMD_BACKUP_CREATE_ACK: ClassVar[uint8] = 2
    CMD_SYSTEM_RESTORED: ClassVar[uint8] = 3
    BACKUP_CREATE_NACK: ClassVar[uint8] = 0
    BACKUP_CREATE_ACK: ClassVar[uint8] = 1
    SYSTEM_RESTORED_RESPONSE_UNKNOWN: ClassVar[uint8] = 0
    SYSTEM_RESTORED_RESPONSE_FAILED: ClassVar[uint8] = 1
    SYSTEM_RESTORED_RESPONSE_RESTORED: ClassVar[uint8] = 2
    SYSTEM_RESTORED_RESPONSE_NOT_RESTORED: ClassVar[uint8] = 3

    cmd: uint8 = 0
    reserved0: Annotated[Ints, Array[uint8, 3]] = DEFAULT
    response: uint8 = 0
    reserved1: Annotated[Ints, Array[uint8, 3]] = DEFAULT

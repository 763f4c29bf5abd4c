! The plugin interface of Fretwork, version 1, for Fortran: the same as fretwork.h, where every
! field is described. Made from the header; gfortran -std=f2018.
module fretwork
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int32_t), parameter :: FW_ABI_MAJOR = 1
  integer(c_int32_t), parameter :: FW_ABI_MINOR = 1
  integer(c_int32_t), parameter :: FW_KIND_CONTACT = 1
  integer(c_int32_t), parameter :: FW_KIND_COHESION = 2
  integer(c_int32_t), parameter :: FW_KIND_DAMAGE = 3
  integer(c_int32_t), parameter :: FW_KIND_WEAR = 4
  integer(c_int32_t), parameter :: FW_KIND_TRANSPORT = 5
  integer(c_int32_t), parameter :: FW_OK = 0
  integer(c_int32_t), parameter :: FW_ERROR = 1
  integer(c_int32_t), parameter :: FW_BAD_PARAMETER = 2
  integer(c_int32_t), parameter :: FW_REDUCE_STEP = 3
  integer(c_int32_t), parameter :: FW_PANIC = 4
  integer(c_int64_t), parameter :: FW_FLAG_2D_ONLY = shiftl(1_c_int64_t, 0)
  integer(c_int64_t), parameter :: FW_FLAG_3D_ONLY = shiftl(1_c_int64_t, 1)
  integer(c_int64_t), parameter :: FW_FLAG_TENSION_ONLY = shiftl(1_c_int64_t, 2)
  integer(c_int64_t), parameter :: FW_FLAG_OPENING = shiftl(1_c_int64_t, 3)
  integer(c_int64_t), parameter :: FW_FLAG_CONSTANT = shiftl(1_c_int64_t, 4)
  integer(c_int64_t), parameter :: FW_FLAG_MOMENT = shiftl(1_c_int64_t, 5)
  integer(c_int64_t), parameter :: FW_FLAG_BREAKS = shiftl(1_c_int64_t, 6)
  integer(c_int64_t), parameter :: FW_FLAG_FORMS = shiftl(1_c_int64_t, 7)
  integer(c_int64_t), parameter :: FW_FLAG_COMPLIANT = shiftl(1_c_int64_t, 8)
  integer(c_int64_t), parameter :: FW_FLAG_TEMPERATURE = shiftl(1_c_int64_t, 9)

  type, bind(c) :: fw_field
    type(c_ptr) :: name = c_null_ptr
    type(c_ptr) :: unit = c_null_ptr
    type(c_ptr) :: doc = c_null_ptr
    real(c_double) :: default_value = 0.0_c_double
    real(c_double) :: minimum = 0.0_c_double
    real(c_double) :: maximum = 0.0_c_double
    integer(c_int64_t) :: flags = 0
  end type fw_field

  type, bind(c) :: fw_message
    integer(c_size_t) :: size = 0
    type(c_ptr) :: text = c_null_ptr
    integer(c_size_t) :: capacity = 0
    integer(c_int64_t) :: contact = 0
  end type fw_message

  type, bind(c) :: fw_batch
    integer(c_size_t) :: size = 0
    integer(c_size_t) :: n = 0
    integer(c_int32_t) :: dimension = 0
    integer(c_int32_t) :: reserved = 0
    real(c_double) :: time = 0.0_c_double
    real(c_double) :: h = 0.0_c_double
    real(c_double) :: theta = 0.0_c_double
    real(c_double) :: degradation = 0.0_c_double
    type(c_ptr) :: parameters = c_null_ptr
    type(c_ptr) :: state = c_null_ptr
    type(c_ptr) :: state_next = c_null_ptr
    type(c_ptr) :: gap = c_null_ptr
    type(c_ptr) :: area = c_null_ptr
    type(c_ptr) :: radius = c_null_ptr
    type(c_ptr) :: age = c_null_ptr
    type(c_ptr) :: opening_n = c_null_ptr
    type(c_ptr) :: opening_t1 = c_null_ptr
    type(c_ptr) :: opening_t2 = c_null_ptr
    type(c_ptr) :: velocity_n = c_null_ptr
    type(c_ptr) :: velocity_t1 = c_null_ptr
    type(c_ptr) :: velocity_t2 = c_null_ptr
    type(c_ptr) :: impulse_n = c_null_ptr
    type(c_ptr) :: impulse_t1 = c_null_ptr
    type(c_ptr) :: impulse_t2 = c_null_ptr
    type(c_ptr) :: damage = c_null_ptr
    type(c_ptr) :: energy_intact = c_null_ptr
    type(c_ptr) :: intact_n = c_null_ptr
    type(c_ptr) :: intact_t1 = c_null_ptr
    type(c_ptr) :: intact_t2 = c_null_ptr
    type(c_ptr) :: slip = c_null_ptr
    type(c_ptr) :: friction_work = c_null_ptr
    type(c_ptr) :: pressed = c_null_ptr
    type(c_ptr) :: rotation_n = c_null_ptr
    type(c_ptr) :: rotation_t1 = c_null_ptr
    type(c_ptr) :: rotation_t2 = c_null_ptr
    type(c_ptr) :: intact_moment_n = c_null_ptr
    type(c_ptr) :: intact_moment_t1 = c_null_ptr
    type(c_ptr) :: intact_moment_t2 = c_null_ptr
    type(c_ptr) :: out_friction = c_null_ptr
    type(c_ptr) :: out_restitution_n = c_null_ptr
    type(c_ptr) :: out_restitution_t = c_null_ptr
    type(c_ptr) :: out_tension_strength = c_null_ptr
    type(c_ptr) :: out_shear_cohesion = c_null_ptr
    type(c_ptr) :: out_rolling = c_null_ptr
    type(c_ptr) :: out_spinning = c_null_ptr
    type(c_ptr) :: out_traction_n = c_null_ptr
    type(c_ptr) :: out_traction_t1 = c_null_ptr
    type(c_ptr) :: out_traction_t2 = c_null_ptr
    type(c_ptr) :: out_stiffness_n = c_null_ptr
    type(c_ptr) :: out_stiffness_t = c_null_ptr
    type(c_ptr) :: out_damping_n = c_null_ptr
    type(c_ptr) :: out_damping_t = c_null_ptr
    type(c_ptr) :: out_energy = c_null_ptr
    type(c_ptr) :: out_damage = c_null_ptr
    type(c_ptr) :: out_volume = c_null_ptr
    type(c_ptr) :: out_moment_n = c_null_ptr
    type(c_ptr) :: out_moment_t1 = c_null_ptr
    type(c_ptr) :: out_moment_t2 = c_null_ptr
    type(c_ptr) :: out_stiffness_twist = c_null_ptr
    type(c_ptr) :: out_stiffness_bend = c_null_ptr
    ! Since version 1.1; null for a contact law without FW_FLAG_COMPLIANT.
    type(c_ptr) :: overlap = c_null_ptr
    type(c_ptr) :: effective_mass = c_null_ptr
    type(c_ptr) :: spring_t1 = c_null_ptr
    type(c_ptr) :: spring_t2 = c_null_ptr
    type(c_ptr) :: spring_before_t1 = c_null_ptr
    type(c_ptr) :: spring_before_t2 = c_null_ptr
    type(c_ptr) :: out_contact_force_n = c_null_ptr
    type(c_ptr) :: out_contact_force_t1 = c_null_ptr
    type(c_ptr) :: out_contact_force_t2 = c_null_ptr
    type(c_ptr) :: out_contact_stiffness_n = c_null_ptr
    type(c_ptr) :: out_contact_stiffness_t = c_null_ptr
    type(c_ptr) :: out_contact_unloading_t = c_null_ptr
    type(c_ptr) :: out_contact_damping_n = c_null_ptr
    type(c_ptr) :: out_contact_damping_t = c_null_ptr
    ! Since version 1.1; null where the case computes no heat.
    type(c_ptr) :: temperature = c_null_ptr
    type(c_ptr) :: temperature_candidate = c_null_ptr
    type(c_ptr) :: temperature_antagonist = c_null_ptr
    type(c_ptr) :: conductivity = c_null_ptr
    type(c_ptr) :: resistivity = c_null_ptr
    type(c_ptr) :: out_conductance = c_null_ptr
    type(c_ptr) :: out_electric_conductance = c_null_ptr
  end type fw_batch

  type, bind(c) :: fw_plugin
    integer(c_size_t) :: size = 0
    integer(c_int32_t) :: abi_major = 0
    integer(c_int32_t) :: abi_minor = 0
    integer(c_int32_t) :: kind = 0
    integer(c_int32_t) :: reserved = 0
    integer(c_int64_t) :: flags = 0
    type(c_ptr) :: name = c_null_ptr
    type(c_ptr) :: version = c_null_ptr
    type(c_ptr) :: doc = c_null_ptr
    type(c_ptr) :: reference = c_null_ptr
    integer(c_size_t) :: n_parameters = 0
    type(c_ptr) :: parameters = c_null_ptr
    integer(c_size_t) :: n_variables = 0
    type(c_ptr) :: variables = c_null_ptr
    real(c_double) :: degradation = 0.0_c_double
    type(c_funptr) :: validate = c_null_funptr
    type(c_funptr) :: initialise = c_null_funptr
    type(c_funptr) :: prepare = c_null_funptr
    type(c_funptr) :: solve_local = c_null_funptr
    type(c_funptr) :: commit = c_null_funptr
    type(c_funptr) :: energy = c_null_funptr
    type(c_funptr) :: fracture_energy = c_null_funptr
  end type fw_plugin

contains

  ! A column of the batch as an array; an absent column has size 0.
  function column(pointer, n) result(values)
    type(c_ptr), intent(in) :: pointer
    integer(c_size_t), intent(in) :: n
    real(c_double), pointer :: values(:)
    real(c_double), target, save :: none(0)
    if (c_associated(pointer)) then
      call c_f_pointer(pointer, values, [n])
    else
      values => none
    end if
  end function column

  ! Column k (from 1) of the internal variables.
  function variable(pointers, k, n) result(values)
    type(c_ptr), intent(in) :: pointers
    integer, intent(in) :: k
    integer(c_size_t), intent(in) :: n
    real(c_double), pointer :: values(:)
    type(c_ptr), pointer :: columns(:)
    call c_f_pointer(pointers, columns, [k])
    values => column(columns(k), n)
  end function variable

  ! Says what went wrong; contact counts from 1, 0 for none.
  subroutine tell(message, contact, text)
    type(fw_message), intent(inout) :: message
    integer(c_size_t), intent(in) :: contact
    character(*), intent(in) :: text
    character(kind=c_char), pointer :: to(:)
    integer(c_size_t) :: i, n
    message%contact = int(contact, c_int64_t) - 1
    if (.not. c_associated(message%text) .or. message%capacity == 0) return
    call c_f_pointer(message%text, to, [message%capacity])
    n = min(int(len(text), c_size_t), message%capacity - 1)
    do i = 1, n
      to(i) = text(i:i)
    end do
    to(n + 1) = c_null_char
  end subroutine tell

  ! Fills a field of a schema; the texts must be targets that end in c_null_char.
  function field(name, unit, doc, default_value, minimum, maximum) result(f)
    character(kind=c_char), intent(in), target :: name(*), unit(*), doc(*)
    real(c_double), intent(in) :: default_value, minimum, maximum
    type(fw_field) :: f
    f%name = c_loc(name)
    f%unit = c_loc(unit)
    f%doc = c_loc(doc)
    f%default_value = default_value
    f%minimum = minimum
    f%maximum = maximum
  end function field
end module fretwork

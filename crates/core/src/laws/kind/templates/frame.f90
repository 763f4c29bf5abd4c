@@ HEAD
! @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
! fretwork.h documents the content and unit of every column, and when each call is made.
module law
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use fretwork
  implicit none
  private
@@ STORE
  type(fw_field), target, save :: parameters(count)
  character(kind=c_char), target, save :: names(longest, count), units(longest, count), docs(longest, count)
  character(kind=c_char), target, save :: about(longest, 4)
  type(fw_plugin), target, save :: table
  logical, save :: filled = .false.

contains
@@ TABLE
  ! The one exported function.
  function fretwork_plugin() bind(c, name="fretwork_plugin") result(plugin)
    type(c_ptr) :: plugin
    if (.not. filled) then
      about(:, 1) = text("@NAME@")
      about(:, 2) = text("0.1.0")
      about(:, 4) = text("say where the equations come from")
      table%size = c_sizeof(table)
      table%abi_major = FW_ABI_MAJOR
      table%abi_minor = FW_ABI_MINOR
      table%kind = FW_KIND_@KINDUP@
      table%name = c_loc(about(1, 1))
      table%version = c_loc(about(1, 2))
      table%doc = c_loc(about(1, 3))
      table%reference = c_loc(about(1, 4))
      table%n_parameters = count
      table%parameters = c_loc(parameters)
@@ END
      filled = .true.
    end if
    plugin = c_loc(table)
  end function fretwork_plugin

  ! Null-terminated text.
  pure function text(words) result(out)
    character(*), intent(in) :: words
    character(kind=c_char) :: out(longest)
    integer :: i
    out = c_null_char
    do i = 1, min(len_trim(words), longest - 1)
      out(i) = words(i:i)
    end do
  end function text

  ! One line of the schema.
  function schema(name, unit, doc, name_text, unit_text, doc_text, default_value, minimum, maximum) result(f)
    character(kind=c_char), intent(inout), target :: name(longest), unit(longest), doc(longest)
    character(*), intent(in) :: name_text, unit_text, doc_text
    real(c_double), intent(in) :: default_value, minimum, maximum
    type(fw_field) :: f
    name = text(name_text)
    unit = text(unit_text)
    doc = text(doc_text)
    f = field(name, unit, doc, default_value, minimum, maximum)
  end function schema
end module law
